// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/camera_commands.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <ostream>

#include "basestation/fleet/fleet.hpp"
#include "basestation/report/table.hpp"
#include "perception/map/export/map_file.hpp"

namespace adit::station {
namespace {

using command::Request;
using command::verb;

Outcome camera_refused(const Request& request, const Error& error) {
  return refused_outcome(request, error.reason, error.text);
}

std::string at_text(const std::optional<std::array<float, 4>>& place) {
  if (!place) return {};
  char text[64];
  (void)std::snprintf(text, sizeof text, ", robot at %.1f %.1f", static_cast<double>((*place)[0]),
                      static_cast<double>((*place)[1]));
  return text;
}

std::string age_text(double age) {
  char text[48];
  (void)std::snprintf(text, sizeof text, "%.1f s", age);
  return text;
}

}  // namespace

void CameraCommands::run(const Request& request, const Done& done) {
  const auto camera = cameras_.named(request.robots.front(), request.word("NAME"));
  if (!camera) return done(camera_refused(request, camera.error()));
  if (request.verb == verb("camera shot")) return shoot(request, *camera, done);
  if (request.word("STATE") == "on") return switch_on(request, *camera, done);
  if (const auto off = cameras_.set_on(request.robots.front(), *camera, false); !off)
    return done(camera_refused(request, off.error()));
  done(done_outcome(request, request.robots.front() + ": camera " + *camera + " is off\n",
                    {{"robot", request.robots.front()}, {"camera", *camera}, {"on", false}}));
}

void CameraCommands::switch_on(const Request& request, const std::string& camera, const Done& done) {
  if (const auto on = cameras_.set_on(request.robots.front(), camera, true); !on)
    return done(camera_refused(request, on.error()));
  await_first(request, camera, strand_.now() + kFirst, done);
}

void CameraCommands::await_first(const Request& request, const std::string& camera, Time until,
                                 const Done& done) {
  const std::string& robot = request.robots.front();
  cameras_.next(
      robot, camera, 0,
      [this, request, camera, until, done, alive = std::weak_ptr(alive_)](const CameraPicture& picture) {
        if (alive.expired()) return;
        const std::string& of = request.robots.front();
        if (picture.number != 0)
          return done(done_outcome(request,
                                   of + ": camera " + camera + " is on: " + std::to_string(picture.width) +
                                       " x " + std::to_string(picture.height) + ", " + age_text(picture.age) +
                                       " old\n",
                                   {{"robot", of},
                                    {"camera", camera},
                                    {"on", true},
                                    {"width", picture.width},
                                    {"height", picture.height},
                                    {"age", picture.age}}));
        if (strand_.now() < until) return await_first(request, camera, until, done);
        done(camera_refused(request,
                            {Reason::no_answer, "the camera is on, but no picture came yet: `health " + of +
                                                    "` says whether its driver sends any"}));
      });
}

void CameraCommands::shoot(const Request& request, const std::string& camera, const Done& done) {
  const std::string file = request.word("FILE");
  const auto ending = std::filesystem::path(file).extension();
  if (ending != ".jpg" && ending != ".jpeg")
    return done(camera_refused(request, {Reason::bad_argument, file + ": pictures are written as .jpg"}));
  const auto asked = cameras_.shoot(
      request.robots.front(), camera,
      [this, request, camera, done, alive = std::weak_ptr(alive_)](const Result<ShotPicture>& picture) {
        if (alive.expired()) return;
        if (!picture) return done(camera_refused(request, picture.error()));
        write(request, camera, *picture, done);
      });
  if (!asked) done(camera_refused(request, asked.error()));
}

void CameraCommands::write(const Request& request, const std::string& camera, const ShotPicture& picture,
                           const Done& done) {
  const std::string file = request.word("FILE");
  strand_.compute(
      {.name = "camera file", .modelled = 20ms, .watchdog = 60s, .pool = PoolKind::io},
      [bytes = picture.jpeg, file] { return perception::write_file_atomically(file, bytes); },
      [request, camera, done, file, size = picture.jpeg.size(), age = picture.age, place = picture.place,
       alive = std::weak_ptr(alive_)](const Result<void>& written) {
        if (alive.expired()) return;
        if (!written) return done(camera_refused(request, written.error()));
        done(done_outcome(request,
                          "the picture of " + request.robots.front() + "'s camera " + camera + " is in " +
                              file + ": " + std::to_string((size + 512) / 1024) + " kB" + at_text(place) +
                              "\n",
                          {{"robot", request.robots.front()},
                           {"camera", camera},
                           {"file", file},
                           {"bytes", size},
                           {"age", age}}));
      });
}

Outcome cameras_outcome(const Request& request, const Fleet& fleet, const Cameras& cameras) {
  std::vector<std::vector<std::string>> rows{{"robot", "camera", "state", "size", "rate", "kbit/s", "age"}};
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, robot] : fleet.robots()) {
    if (!request.robots.empty() && std::ranges::find(request.robots, name) == request.robots.end()) continue;
    for (const CameraStatus& camera : cameras.status(robot)) {
      const bool shown = camera.width > 0;
      const std::string size = std::to_string(camera.width) + "x" + std::to_string(camera.height);
      rows.push_back({name, camera.name, camera.on ? (shown ? "on" : "waits") : "off", shown ? size : "-",
                      shown ? fixed(static_cast<double>(camera.rate), 1) : "-",
                      shown ? fixed(static_cast<double>(camera.bytes) * 8e-3, 0) : "-",
                      shown ? fixed(camera.age, 1) + " s" : "-"});
      list.push_back({{"robot", name},
                      {"camera", camera.name},
                      {"on", camera.on},
                      {"width", camera.width},
                      {"height", camera.height},
                      {"rate", camera.rate},
                      {"bytes_per_second", camera.bytes},
                      {"age", camera.age}});
    }
  }
  for (const std::string& name : request.robots)
    if (fleet.robot(name) == nullptr)
      return camera_refused(request, {Reason::unknown_robot, name + " has not been heard"});
  return done_outcome(request, rows.size() > 1 ? table(rows) : "no robot that is heard has a camera\n",
                      {{"cameras", list}});
}

}  // namespace adit::station

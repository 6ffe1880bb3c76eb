// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/map_commands.hpp"

#include <filesystem>
#include <utility>

#include "basestation/map/ground_area.hpp"
#include "basestation/map/merged_map.hpp"
#include "basestation/map/status.hpp"
#include "basestation/report/table.hpp"
#include "core/command/vocabulary.hpp"
#include "perception/map/export/map_file.hpp"

namespace adit::station {
namespace {

using command::Request;
using command::verb;
using perception::VoxelImage;

constexpr double kPictureResolution = 0.2;  // m

JobSpec file_job(const char* name) {
  return {.name = name,
          .modelled = std::chrono::milliseconds(300),
          .watchdog = std::chrono::seconds(60),
          .pool = PoolKind::io};
}

Outcome failed(const Request& request, const Error& error) {
  return refused_outcome(request, error.reason, "map: " + error.text, error.text);
}

}  // namespace

void MapCommands::run(const Request& request, const Done& done) {
  if (request.verb == verb("map save")) return save(request, done);
  if (request.verb == verb("map load")) return load(request, done);
  if (request.verb == verb("map picture")) return draw(request, done);
  if (request.verb == verb("map status")) return done(status(request));
  const std::size_t robots = content_.chunks().robots().size();
  content_.forget_maps();
  done(done_outcome(request, "forgot the maps of " + std::to_string(robots) + " robots\n"));
}

Outcome MapCommands::status(const Request& request) const {
  const Time now = strand_.now();
  return done_outcome(request,
                      map_status_text(content_.maps(), now) +
                          (content_.prior ? "the map that was loaded lies below what robots saw\n" : ""),
                      map_status_json(content_.maps(), now));
}

void MapCommands::save(const Request& request, const Done& done) {
  const std::string file = request.word("FILE"), robot = request.word("--robot");
  if (!robot.empty() && !content_.chunks().robots().contains(robot))
    return done(failed(request, {Reason::map_empty, "no map of " + robot + " has been received"}));
  perception::SaveOptions options{};
  if (request.has("--floor")) options.floor = static_cast<std::size_t>(request.number("--floor"));
  strand_.compute(
      file_job("map save"),
      [parts = parts_of(content_.chunks(), robot), prior = robot.empty() ? content_.prior : nullptr, options,
       file, resolution = request.number("--resolution")] {
        return perception::save_map(merged(parts, prior.get(), resolution), file, options);
      },
      [request, done, file, alive = std::weak_ptr(alive_)](const Result<void>& written) {
        if (alive.expired()) return;
        done(written ? done_outcome(request, "saved " + file + "\n", {{"file", file}})
                     : failed(request, written.error()));
      });
}

void MapCommands::load(const Request& request, const Done& done) {
  strand_.compute(
      file_job("map load"),
      [file = request.word("FILE")]() -> Result<std::shared_ptr<const VoxelImage>> {
        auto image = perception::load_map(file);
        if (!image) return image.error();
        return std::shared_ptr<const VoxelImage>(std::make_shared<VoxelImage>(std::move(*image)));
      },
      [this, request, done,
       alive = std::weak_ptr(alive_)](const Result<std::shared_ptr<const VoxelImage>>& loaded) {
        if (alive.expired()) return;
        if (!loaded) return done(failed(request, loaded.error()));
        content_.prior = *loaded;
        done(done_outcome(request, "loaded " + request.word("FILE") + "; what robots see replaces it\n"));
      });
}

void MapCommands::draw(const Request& request, const Done& done) {
  const std::string file = request.word("FILE");
  if (std::filesystem::path(file).extension() != ".png")
    return done(failed(request, {Reason::bad_argument, file + ": a picture is a .png"}));
  strand_.compute(
      file_job("map picture"),
      [parts = parts_of(content_.chunks()), prior = content_.prior, picture = picture(), file] {
        return write_map_picture(merged(parts, prior.get(), kPictureResolution), picture, file);
      },
      [request, done, file, alive = std::weak_ptr(alive_)](const Result<void>& drawn) {
        if (alive.expired()) return;
        done(drawn ? done_outcome(request, "drawn: " + file + "\n") : failed(request, drawn.error()));
      });
}

MapPicture MapCommands::picture() const {
  const ChunkStore& chunks = content_.chunks();
  MapPicture picture{.title = "map of station " + params_.name};
  for (const auto& [name, trail] : trails_.all()) {
    MapPicture::Robot robot{.name = name, .trail = trail.points, .now = trail.now};
    if (const RobotView* view = fleet_.robot(name)) {
      robot.label = view->platform;
      if (view->size.length > 0) robot.length = view->size.length;
      if (view->size.width > 0) robot.width = view->size.width;
    }
    if (chunks.robots().contains(name))
      robot.label += ", saw " + fixed(ground_area(chunks, strand_.now(), name).m2, 0) + " m2";
    picture.robots.push_back(std::move(robot));
  }
  std::uint64_t bytes = 0;
  for (const auto& [name, robot] : chunks.robots()) bytes += robot.bytes;
  picture.subtitle = fixed(ground_area(chunks, strand_.now()).m2, 0) + " m2 by " +
                     std::to_string(chunks.robots().size()) + " robots, " +
                     fixed(static_cast<double>(bytes) / 1000.0, 0) + " kB received";
  return picture;
}

void MapCommands::follow_robots() {
  for (const auto& [name, robot] : fleet_.robots())
    if (robot.located) trails_.add(name, {robot.x, robot.y, robot.yaw});
}

}  // namespace adit::station

// SPDX-License-Identifier: Apache-2.0
// The commands `map ...`: what a station does with the map that it received. Merging and writing run on a
// thread of the pool, so that they delay no command.
#include <filesystem>
#include <utility>

#include "basestation/map/merged_map.hpp"
#include "basestation/map/picture.hpp"
#include "basestation/map/status.hpp"
#include "basestation/report/table.hpp"
#include "basestation/station_impl.hpp"
#include "core/command/vocabulary.hpp"
#include "perception/map/export/map_file.hpp"

namespace adit::station {
namespace {

using command::Request;
using command::verb;

constexpr Duration kModelledFile = 300ms;
constexpr double kPictureResolution = 0.2;  // m

Outcome failed(const Request& request, const Error& error) {
  Outcome outcome{.exit_code = 1, .error = "map: " + error.text + "\n"};
  outcome.json = {{"command", request.info->name}, {"exit", 1}, {"ok", false}};
  outcome.json["reason"] = name(error.reason);
  outcome.json["error"] = error.text;
  return outcome;
}

Outcome succeeded(const Request& request, const std::string& text) {
  Outcome outcome{.text = text};
  outcome.json = {{"command", request.info->name}, {"exit", 0}, {"ok", true}};
  return outcome;
}

}  // namespace

void Station::Impl::answer_map(const Request& request, const Done& done) {
  if (request.verb == verb("map save")) return save_map(request, done);
  if (request.verb == verb("map load")) return load_map(request, done);
  if (request.verb == verb("map picture")) return draw_map(request, done);
  if (request.verb == verb("map forget")) {
    const std::size_t robots = map_.chunks().robots().size();
    map_.forget(drawn_start());
    prior_.reset();
    return done(succeeded(request, "forgot the maps of " + std::to_string(robots) + " robots\n"));
  }
  Outcome outcome = succeeded(request, map_status_text(map_.receiver(), strand_.now()));
  outcome.json.update(map_status_json(map_.receiver(), strand_.now()));
  if (prior_) outcome.text += "the map that was loaded lies below what robots saw\n";
  done(outcome);
}

void Station::Impl::save_map(const Request& request, const Done& done) {
  const std::string file = request.word("FILE"), robot = request.word("--robot");
  if (!robot.empty() && !map_.chunks().robots().contains(robot))
    return done(failed(request, {Reason::map_empty, "no map of " + robot + " has been received"}));
  perception::SaveOptions options{};
  if (request.has("--floor")) options.floor = static_cast<std::size_t>(request.number("--floor"));
  strand_.compute(
      {.name = "map save", .modelled = kModelledFile, .watchdog = 60s, .pool = PoolKind::io},
      [parts = parts_of(map_.chunks(), robot), prior = robot.empty() ? prior_ : nullptr, options, file,
       resolution = request.number("--resolution")] {
        const perception::VoxelImage image = merged(parts, prior.get(), resolution);
        return perception::save_map(image, file, options);
      },
      [request, done, alive = std::weak_ptr(alive_)](const Result<void>& written) {
        if (alive.expired()) return;
        if (!written) return done(failed(request, written.error()));
        Outcome outcome = succeeded(request, "saved " + request.word("FILE") + "\n");
        outcome.json["file"] = request.word("FILE");
        done(outcome);
      });
}

void Station::Impl::load_map(const Request& request, const Done& done) {
  strand_.compute(
      {.name = "map load", .modelled = kModelledFile, .watchdog = 60s, .pool = PoolKind::io},
      [file = request.word("FILE")]() -> Result<std::shared_ptr<const perception::VoxelImage>> {
        auto image = perception::load_map(file);
        if (!image) return image.error();
        return std::shared_ptr<const perception::VoxelImage>(
            std::make_shared<perception::VoxelImage>(std::move(*image)));
      },
      [this, request, done,
       alive = std::weak_ptr(alive_)](const Result<std::shared_ptr<const perception::VoxelImage>>& loaded) {
        if (alive.expired()) return;
        if (!loaded) return done(failed(request, loaded.error()));
        prior_ = *loaded;
        done(succeeded(request, "loaded " + request.word("FILE") + "; what robots see replaces it\n"));
      });
}

void Station::Impl::draw_map(const Request& request, const Done& done) {
  const std::string file = request.word("FILE");
  if (std::filesystem::path(file).extension() != ".png")
    return done(failed(request, {Reason::bad_argument, file + ": a picture is a .png"}));
  MapPicture picture{.title = "map of station " + params_.name};
  for (const auto& [name, trail] : trails_.all()) {
    MapPicture::Robot robot{.name = name, .trail = trail.points, .now = trail.now};
    if (const RobotView* view = fleet_.robot(name)) {
      robot.label = view->platform;
      if (view->size.length > 0) robot.length = view->size.length;
      if (view->size.width > 0) robot.width = view->size.width;
    }
    if (map_.chunks().robots().contains(name))
      robot.label += ", saw " + fixed(map_.chunks().area(name), 0) + " m2";
    picture.robots.push_back(std::move(robot));
  }
  std::uint64_t bytes = 0;
  for (const auto& [name, robot] : map_.chunks().robots()) bytes += robot.bytes;
  picture.subtitle = fixed(map_.chunks().area(), 0) + " m2 by " +
                     std::to_string(map_.chunks().robots().size()) + " robots, " +
                     fixed(static_cast<double>(bytes) / 1000.0, 0) + " kB received";
  strand_.compute(
      {.name = "map picture", .modelled = kModelledFile, .watchdog = 60s, .pool = PoolKind::io},
      [parts = parts_of(map_.chunks()), prior = prior_, picture = std::move(picture), file] {
        return write_map_picture(merged(parts, prior.get(), kPictureResolution), picture, file);
      },
      [request, done, alive = std::weak_ptr(alive_)](const Result<void>& drawn) {
        if (alive.expired()) return;
        if (!drawn) return done(failed(request, drawn.error()));
        done(succeeded(request, "drawn: " + request.word("FILE") + "\n"));
      });
}

}  // namespace adit::station

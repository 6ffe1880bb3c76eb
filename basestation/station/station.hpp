// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "basestation/camera/cameras.hpp"
#include "basestation/commands/commands.hpp"
#include "basestation/content/content.hpp"
#include "basestation/fleet/presence.hpp"
#include "basestation/map/map_view.hpp"
#include "basestation/model/stairs.hpp"
#include "basestation/model/world.hpp"
#include "core/command/parse.hpp"

namespace adit::station {

/// One operator's station: fleet model, command sender, joystick and the command lines. It runs on one
/// strand: construct, call and destroy it there (or while the strand does not run). The same class runs live
/// and in rehearsal: clock, randomness and participant are passed in.
class Station {
 public:
  using Done = Commands::Done;

  Station(StationParams params, Executor& strand, wire::Participant& radio);
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  /// Opens its topics and announces itself. Errors: bad_argument (the name), wire_failed.
  Result<void> start();

  /// Runs one command line; `done` is called once, at once or later. Returns a handle for cancel(). The lines
  /// that need a terminal or files (watch, teleop, run) are refused here with wrong usage.
  std::uint64_t execute(const std::string& line, const Done& done) {
    return execute(command::parse(line), done);
  }
  std::uint64_t execute(const Result<command::Request>& request, const Done& done) {
    return commands_.execute(request, done);
  }
  /// Cancels a running command: a drive streams zero and ends its stream, a wait ends. Its `done` gets
  /// `cancelled`. An unknown handle is ignored.
  void cancel(std::uint64_t handle) { commands_.cancel(handle); }

  /// Starts manual control of one robot by a live stick until cancelled; `done` reports how it ended.
  std::uint64_t teleop(const std::string& robot, Done done) {
    return commands_.teleop(robot, std::move(done));
  }
  /// Sets the stick of a running teleop. Zero is sent if it is not renewed for 0.25 s.
  void stick(std::uint64_t handle, const StickVelocity& velocity) { commands_.stick(handle, velocity); }

  const Fleet& fleet() const { return fleet_; }
  const StationParams& params() const { return params_; }
  Time now() const { return strand_.now(); }
  /// What front ends receive now.
  World world() const;
  /// Counts of commands and answers since the start.
  const Counts& counts() const { return commands_.counts(); }
  /// The newest answer to this operator, from a robot or from the station itself.
  const std::optional<Answer>& last_answer() const { return commands_.last_answer(); }
  /// The map of all robots as this station received it.
  const ChunkStore& map() const { return content_.chunks(); }
  /// The map seen from above: what changed after that revision, at most `most` tiles; call again while
  /// `more`. The view is made at most once a second, on a thread of the pool; `done` is called when it
  /// is complete.
  void map_since(std::uint64_t revision, std::size_t most, MapView::Done done) {
    map_view_.since(revision, most, std::move(done));
  }
  /// Sets what an operator looks at: robots send it first where their map is late. Holds for some seconds.
  void look_at(const LookedAt& place) { content_.look_at(place); }
  /// Number of stored findings of all robots.
  std::size_t findings() const { return content_.desk().all().size(); }
  /// Findings whose whole photo is here.
  std::size_t photos() const { return content_.whole_photos(); }
  /// The bytes of a part of a photo; null: it is not here, or not all of it.
  const store::Bytes* photo(std::uint64_t content, findings::PhotoPart part) const {
    return content_.photos().find(content, part);
  }
  /// The cameras of all robots.
  Cameras& cameras() { return cameras_; }
  const Cameras& cameras() const { return cameras_; }
  /// The staircases of the map, computed from all findings.
  StairsReport stairs() const;
  /// The findings of all robots, as `findings` lists them.
  FoundReport found() const;
  /// True after `down`, until `up`.
  bool closed() const { return !presence_.up(); }

  /// Observers, called on the strand. Set them before start().
  std::function<void(const StoredNotice&)> on_notice{};
  std::function<void()> on_down{};
  /// Called when something that front ends receive may have changed, at most every 20 ms.
  std::function<void()> on_changed{};

 private:
  template <class T, class Take>
  Result<void> read(const wire::Topic<T>& topic, Take take);
  template <class T>
  Result<void> read(const wire::Topic<T>& topic);
  void observe();
  void changed();
  void tick();

  StationParams params_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet fleet_;
  Random random_;
  Presence presence_;
  Content content_;
  Cameras cameras_;
  Commands commands_;
  MapView map_view_;
  bool change_pending_{false};  ///< on_changed will be called.
  Timer change_timer_{}, tick_timer_{};
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
};

}  // namespace adit::station

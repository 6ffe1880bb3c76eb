// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "basestation/client/options.hpp"
#include "basestation/model/action.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/stick_velocity.hpp"
#include "basestation/model/world.hpp"
#include "core/result/result.hpp"

namespace adit::station::client {

/// What changed since the last take().
struct Changes {
  bool world{}, map{}, link{};
  std::vector<Notice> notices{};         ///< In their order.
  std::vector<CommandEvent> commands{};  ///< In their order, of all front ends.
  std::size_t missed{};  ///< Notices and events that did not come, because they were not taken.
};

/// The connection to the station.
struct Link {
  bool connected{};
  double silent_for{};  ///< Time since the last snapshot, s.
  std::string why{};    ///< Why there is no connection, or which message was not understood.
};

/// A front end's view of its station, for programs with a loop of their own. Thread safe; one thread inside
/// reads and writes, so no call waits for the station, and a caller that hangs holds nothing up.
///
/// When the connection ends, all requests end with kExitNoAnswer, and it is sought again five times a second.
/// No station is started for that, because the operator may have ended it: see start_station().
class Station {
 public:
  using RequestId = std::int64_t;
  using Done = std::function<void(const CommandOutcome&)>;
  static constexpr std::size_t kMaxChanges = 1024;  ///< Notices and events stored for take(), each.

  /// Connects, or starts the station. `front_end`: name under which other front ends see this one.
  static Result<std::unique_ptr<Station>> open(const StationOptions& options, const std::string& front_end);
  ~Station();
  /// What the operator should know of the connection, e.g. that a station was started; empty: nothing.
  const std::string& remark() const { return remark_; }

  /// The newest snapshot; never null.
  std::shared_ptr<const World> world() const;
  /// The map as far as it came; never null. See want_map().
  std::shared_ptr<const TileMap> map() const;
  Link link() const;

  /// Sets the function that is called when there is something to take(): from any thread, and not again
  /// before take(). Set it once.
  void on_change(std::function<void()> poke);
  /// Returns all changes since the last call, and calls the `done` of requests that ended. For the owner's
  /// thread.
  Changes take();

  /// Runs a command line of the grammar.
  RequestId execute(const std::string& line, Done done);
  /// Drives a robot by a stick until cancelled; zero is sent if the stick is not renewed for 0.25 s.
  RequestId drive(const std::string& robot, Done done);
  void stick(RequestId drive, const StickVelocity& velocity);
  void cancel(RequestId request);
  /// Software stop of these robots, or of all if there is none, on a connection of its own: it does not wait
  /// behind other requests. If the station does not begin within 0.3 s, the program `basestation stop` stops
  /// them without it.
  void stop(const std::vector<std::string>& robots, Done done);

  /// What each robot of that selection would accept now, of world().
  std::vector<Action> actions(const std::vector<std::string>& robots) const;
  /// Whether the map is asked for, once a second.
  void want_map(bool wanted);
  /// Sets what robots send first of a map that is late; nothing: no place.
  void look_at(const std::optional<LookedAt>& place);
  /// Starts the station again after it ended.
  Result<void> start_station();

 private:
  class Impl;
  explicit Station(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
  std::string remark_{};
};

}  // namespace adit::station::client

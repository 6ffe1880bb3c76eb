// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "basestation/client/launch.hpp"
#include "basestation/client/options.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/stick_velocity.hpp"
#include "basestation/model/world.hpp"
#include "core/findings/photo_file.hpp"
#include "core/result/result.hpp"

namespace adit::station::client {

class Connection;

/// The changes since the last take().
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
  /// Stops that run at the same time: one takes up to 30 s, and a hand presses a key at most eight times a
  /// second.
  static constexpr std::size_t kMaxStops = 256;

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
  /// before take(). When this returns, the function that was set before is not running and is not called
  /// again; hence not to be called from inside it.
  void on_change(std::function<void()> poke);
  /// Returns all changes since the last call, and calls the `done` of requests that ended. For the owner's
  /// thread.
  Changes take();

  /// Runs a command line of the grammar.
  RequestId execute(const std::string& line, Done done);
  /// Asks for the next picture of a camera; camera_picture_of() reads the outcome.
  RequestId camera(const CameraRequest& request, Done done);
  /// Asks for the bytes of a part of a photo; photo_of() reads the outcome. `id`: FoundPhoto::id.
  RequestId photo(const std::string& id, findings::PhotoPart part, Done done);
  /// Drives a robot by a stick until cancelled; zero is sent if the stick is not renewed for 0.25 s.
  RequestId drive(const std::string& robot, Done done);
  void stick(RequestId drive, const StickVelocity& velocity);
  void cancel(RequestId request);
  /// Software stop of these robots, or of all if there is none, on a connection of its own: it does not wait
  /// behind other requests. If the station does not begin within 0.3 s, the program `basestation stop` stops
  /// them without it. Refused while kMaxStops run. The destructor waits for those that run.
  void stop(const std::vector<std::string>& robots, Done done);

  /// Whether the map is asked for, once a second.
  void want_map(bool wanted);
  /// Sets what robots send first of a map that is late; nothing: no place.
  void look_at(const std::optional<LookedAt>& place);
  /// Starts the station again after it ended.
  Result<void> start_station();

 private:
  using Clock = std::chrono::steady_clock;

  /// A stop under way, in a thread of its own.
  struct RunningStop {
    bool ended{};  ///< Nothing but the end of the thread is left.
    std::thread thread{};
  };

  Station(const StationOptions& options, std::string front_end, Connected connected);
  RequestId ask(std::function<std::int64_t(Connection&)> request, Done done);
  StationOptions options() const;
  /// Joins the threads of the stops that ended.
  void join_ended_stops();
  void wake();
  /// Calls the owner unless that is pending. Releases the lock.
  void poke(std::unique_lock<std::mutex>& guard);
  void end(Done done, CommandOutcome outcome, std::unique_lock<std::mutex>& guard);
  template <class Change>
  void change(const Change& make);
  template <class T>
  void add_change(std::vector<T>& list, const T& value);

  // In the thread.
  void run(LineSocket first);
  void serve(LineSocket socket);
  void write(Connection& connection);
  void listen(Connection& connection);
  void take_map(MapUpdate update, bool more);
  /// Waits for `wake_` or the time.
  void pause(std::chrono::milliseconds time);
  void drain();

  const std::string front_end_;
  const std::string remark_;
  File wake_;
  std::atomic<bool> ending_{false}, map_wanted_{false};

  // Of the thread alone.
  std::map<RequestId, std::int64_t> sent_{};  ///< The connection's id of each open request.
  std::uint64_t run_{};                       ///< The station's run to which the map belongs.
  Clock::time_point next_map_{};              ///< When the map is asked for.

  mutable std::mutex mutex_{};  // Guards all below.
  std::optional<LookedAt> look_{};
  StationOptions options_;  // Domain and network as the running station has them.
  std::shared_ptr<const World> world_{std::make_shared<World>()};
  std::shared_ptr<const TileMap> map_{std::make_shared<TileMap>()};
  Link link_{.connected = true};
  Clock::time_point heard_{Clock::now()};
  Changes changes_{};
  std::function<void()> poke_{};
  int pokes_running_{0};                     ///< Calls of `poke_` that have not returned.
  std::condition_variable poked_through_{};  ///< When `pokes_running_` falls.
  bool poked_{false};
  RequestId next_{1};
  std::deque<std::function<void(Connection&)>> calls_{};  ///< To be written.
  std::map<RequestId, StickVelocity> sticks_{};           ///< The newest of each drive, to be written.
  std::map<RequestId, Done> open_{};
  std::vector<std::pair<Done, CommandOutcome>> ended_{};
  std::list<RunningStop> stops_{};

  std::thread thread_{};
};

}  // namespace adit::station::client

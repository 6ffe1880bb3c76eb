// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "basestation/fleet/fleet.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/stick_velocity.hpp"
#include "basestation/outcome.hpp"
#include "basestation/send/answer.hpp"
#include "core/command/request.hpp"
#include "core/exec/executor.hpp"
#include "core/result/result.hpp"
#include "core/store/disk.hpp"
#include "core/wire/participant.hpp"

namespace adit::station {

class ChunkStore;

/// Parameters of a station: identity and rates.
struct StationParams {
  std::string name{"op1"};  ///< Name of the operator: 1 to 32 characters of [A-Za-z0-9_-].
  Id id{};                  ///< 128 random bits stored on the station's disk.
  std::uint64_t seed{1};    ///< Seed of the phase of the periodic messages.
  std::string software{};   ///< Version that is announced to the peers.
  std::string link{};       ///< Name of the link profile; empty: the traffic is not limited.
  double bandwidth{0.0};    ///< Bandwidth of that link, bit/s; 0: unknown.
  std::optional<std::array<float, 3>> place{};  ///< Position of the station, map frame, m.
  std::shared_ptr<store::Disk> disk{};          ///< Stores findings; null: in memory only.
  bool content{true};                           ///< Takes findings and maps of robots.
  Duration presence{std::chrono::seconds(1)};   ///< Period of the heartbeats, [0.1 s, 1 s].
  /// Time after the start in which a robot may stay unknown.
  Duration discovery_grace{std::chrono::seconds(5)};
  /// After the start queries wait this long, and up to twice as long for missing messages.
  Duration settle{std::chrono::seconds(1)};
};

/// One operator's station: fleet model, command sender, joystick and the command lines. It runs on one
/// strand: construct, call and destroy it there (or while the strand does not run). The same class runs live
/// and in rehearsal: clock, randomness and participant are passed in.
class Station {
 public:
  using Done = std::function<void(const Outcome&)>;

  Station(StationParams params, Executor& strand, wire::Participant& radio);
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  /// Opens its topics and announces itself. Errors: bad_argument (the name), wire_failed.
  Result<void> start();

  /// Runs one command line; `done` is called once, at once or later. Returns a handle for cancel(). The lines
  /// that need a terminal or files (watch, teleop, run) are refused here with wrong usage.
  std::uint64_t execute(const std::string& line, Done done);
  std::uint64_t execute(const Result<command::Request>& request, Done done);
  /// Cancels a running command: a drive streams zero and ends its stream, a wait ends. Its `done` gets
  /// `cancelled`. An unknown handle is ignored.
  void cancel(std::uint64_t handle);

  /// Starts manual control of one robot by a live stick until cancelled; `done` reports how it ended.
  std::uint64_t teleop(const std::string& robot, Done done);
  /// Sets the stick of a running teleop. Zero is sent if it is not renewed for 0.25 s.
  void stick(std::uint64_t handle, const StickVelocity& velocity);

  const Fleet& fleet() const;
  const StationParams& params() const;
  Time now() const;
  /// Counts of commands and answers since the start.
  const Counts& counts() const;
  /// The newest answer to this operator, from a robot or from the station itself.
  const std::optional<Answer>& last_answer() const;
  /// The map of all robots as this station received it.
  const ChunkStore& map() const;
  /// The map seen from above: what changed after that revision, at most `most` tiles; call again while
  /// `more`. The view is made at most once a second, on a thread of the pool; `done` is called when it
  /// is complete.
  using MapDone = std::function<void(MapUpdate update, bool more)>;
  void map_since(std::uint64_t revision, std::size_t most, MapDone done);
  /// Sets what an operator looks at: robots send it first where their map is late. Holds for some seconds.
  void look_at(const LookedAt& place);
  /// Number of stored findings of all robots.
  std::size_t findings() const;
  /// True after `down`, until `up`.
  bool closed() const;

  /// Observers, called on the strand. Set them before start().
  std::function<void(const RobotCommand&, std::uint64_t seq)> on_sent{};
  std::function<void(const Answer&)> on_answer{};
  std::function<void(const StoredNotice&)> on_notice{};
  std::function<void()> on_down{};
  /// Called when something that front ends receive may have changed, at most every 20 ms.
  std::function<void()> on_changed{};

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::station

#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "basestation/fleet/fleet.hpp"
#include "basestation/outcome.hpp"
#include "basestation/send/answer.hpp"
#include "core/command/request.hpp"
#include "core/exec/executor.hpp"
#include "core/store/disk.hpp"
#include "core/wire/participant.hpp"

namespace adit::station {

/// What makes one station: who it is, and its rates.
struct StationParams {
  std::string name{"op1"};                            ///< the operator's: 1 to 32 of [A-Za-z0-9_-]
  Id id{};                                            ///< 128 random bits kept on the station's disk
  std::uint64_t seed{1};                              ///< phase of the periodic messages
  std::string software{};                             ///< version, for the others to see
  std::string link{};                                 ///< name of the link profile; empty: none limits it
  double bandwidth{0.0};                              ///< of that link, bit/s; 0: not known
  std::optional<std::array<float, 3>> place{};        ///< where it stands, map frame, m
  std::shared_ptr<store::Disk> disk{};                ///< where findings are kept; null: in memory alone
  Duration presence{std::chrono::seconds(1)};         ///< between signs of life, [0.1 s, 1 s]
  Duration discovery_grace{std::chrono::seconds(5)};  ///< after the start: how long a robot may stay unknown
  Duration settle{std::chrono::seconds(
      1)};  ///< after the start: queries wait this long, and as long again for what is not heard yet
};

/// One operator's station: fleet model, command sender, joystick and the command lines. Everything happens on
/// one strand: construct, call and destroy it there (or while the strand does not run). The same object
/// serves an operator live and a rehearsal: it takes its clock, its randomness and its wire from outside.
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
  std::uint64_t execute(const command::Request& request, Done done);
  /// Ends what still runs under the handle: a drive streams zero and lets go, a wait ends. Its `done` gets
  /// `cancelled`. An unknown handle is ignored.
  void cancel(std::uint64_t handle);

  /// Manual control of one robot by a live stick until cancelled; `done` tells how it ended.
  std::uint64_t teleop(const std::string& robot, Done done);
  /// The stick of a running teleop: vx vy in m/s, wz in rad/s. Zero is sent when it is not renewed for 0.25
  /// s.
  void stick(std::uint64_t handle, const std::array<double, 3>& velocity);

  const Fleet& fleet() const;
  const StationParams& params() const;
  Time now() const;
  /// What went out and came back since the start.
  const Counts& counts() const;
  /// The newest answer to this operator, of a robot or of the station itself.
  const std::optional<Answer>& last_answer() const;
  /// How many findings of all robots it has.
  std::size_t findings() const;
  /// True after `down`, until `up`.
  bool closed() const;

  /// Observers, called on the strand. Set them before start().
  std::function<void(const RobotCommand&, std::uint64_t seq)> on_sent{};
  std::function<void(const Answer&)> on_answer{};
  std::function<void(const Notice&)> on_notice{};
  std::function<void()> on_down{};

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::station

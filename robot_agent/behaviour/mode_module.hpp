#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>

#include "robot_agent/behaviour/facts.hpp"
#include "robot_agent/command/types.hpp"
#include "robot_agent/motion/mux.hpp"
#include "robot_agent/state/snapshot.hpp"

namespace adit::agent {

/// Goals and poses of the robot are nearer to the map's origin than this, m.
inline constexpr double kFarthestPlace = 10'000.0;

enum class GoalState : std::uint8_t { none, kept, active, blocked, reached };

/// A mode's goal, and how the robot gets on with it.
struct ModeProgress {
  GoalState state{GoalState::none};
  std::uint32_t goal_id{};
  Eigen::Vector3d goal{Eigen::Vector3d::Zero()};  ///< Map frame, m.
  Reason reason{Reason::none};                    ///< Why it is blocked.
};

/// What a mode's module is made with.
struct ModeContext {
  Mux::Output output{};  ///< To the mux: passes while the mode is admitted and the tree runs it.
  std::function<void(const Notice&)> tell_holder{};
  /// Whether no known obstacle covers a place (map frame, m).
  std::function<bool(const Eigen::Vector2d&)> goal_free{};
  /// Height of a goal that was given none, m; empty: it is on the floor.
  std::function<double()> height{};
  /// Where the robot is (map frame); nothing while localisation is not initialised.
  std::function<std::optional<Pose2>()> pose{};
};

/// One mode of the mode table: turns its input into motions for the mux.
///
/// A module decides neither whether its mode may be entered nor whether its output passes: table, guard and
/// tree do. It runs on the command strand. A mode that needs nothing of a call leaves it out.
class ModeModule {
 public:
  ModeModule() = default;
  virtual ~ModeModule() = default;
  ModeModule(const ModeModule&) = delete;
  ModeModule& operator=(const ModeModule&) = delete;

  /// Adds what the module knows to the facts that conditions look at. Asked in every mode.
  virtual void note(Facts&, Time) const {}

  /// The mode was requested and admitted; also when it was the mode before.
  virtual void enter(Time) {}
  /// The mode ended: another one was requested, or the robot fell to hold. A goal is kept.
  virtual void leave(Time) {}
  /// Forgets the goal: the row says `cleared`, and another mode was requested.
  virtual void clear() {}
  /// At 20 Hz and after every change while the mode lasts. `passes`: the output is enabled, and the mode not
  /// paused.
  virtual void tick(bool passes, Time now) = 0;

  /// A fresh sample of the holder's stick (`Accepts::stick`), body frame.
  virtual void stick(const Twist2&, Time) {}
  /// A velocity of the program that steers (`Accepts::program`), body frame. Asked in every mode.
  virtual void program(const Twist2&, Time) {}
  /// Checks a goal (`Accepts::goal`; map frame, m; z NaN: none given), and sets the facts as they would be
  /// with it. Errors: out_of_range.
  virtual Result<void> check_goal(const Eigen::Vector3d&, Facts&) const;
  /// Takes a goal that was checked and admitted; enter() follows.
  virtual void set_goal(const Eigen::Vector3d&) {}
  /// How navigation gets on with the place that was written last.
  virtual void navigated(const Progress&) {}

  /// `passes` as in tick(); false in other modes.
  virtual ModeProgress progress(bool /*passes*/) const { return {}; }

  /// Writes what must survive a restart; equal states write equal bytes.
  virtual void store(KeptBehaviour&) const {}
  /// Takes it back after a restart, before the first tick.
  virtual void restore(const KeptBehaviour&) {}
};

}  // namespace adit::agent

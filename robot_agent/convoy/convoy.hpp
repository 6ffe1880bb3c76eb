// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "nav/convoy/governor.hpp"
#include "nav/convoy/spacing.hpp"
#include "nav/convoy/trail.hpp"
#include "robot_agent/common/notice.hpp"
#include "robot_agent/discovery/peer_table.hpp"

namespace adit::agent {

/// The order of a convoy, as its operator gave it.
struct ConvoyOrder {
  static constexpr std::size_t kMaxRobots = 8;

  std::uint64_t convoy{};             ///< Drawn by the station at each start.
  std::vector<std::string> robots{};  ///< The leader first; 2 to kMaxRobots names, each once.
  double gap{1.5};                    ///< At rest, outline to outline, m.
  double speed{std::numeric_limits<double>::quiet_NaN()};  ///< Of the leader, m/s; NaN: the slowest's.
  bool operator==(const ConvoyOrder&) const = default;

  /// Identifies the names in their order.
  std::uint32_t hash() const;
};

struct ConvoyParams {
  std::string robot{};  ///< Name of this robot.
  double length{};      ///< Of this robot, m.
  double max_speed{};   ///< Of this robot, m/s.
};

/// This robot's place in a convoy: the leader records the path that it drives, and every follower drives
/// along that path behind the robot before it in the order.
///
/// A follower moves only while it hears its predecessor with the same convoy and order, so an order that
/// reached only some of the robots moves none. A robot that says that it left is skipped; no message of
/// another robot adds one or changes the order (rule 8). The place survives a stop and a restart, and
/// ends with `peeloff`, another mode, or another holder. Runs on the command strand.
class Convoy {
 public:
  /// A predecessor silent for longer does not lead: the robot waits (rule 8).
  static constexpr Duration kPredecessorTimeout = 12s;
  static constexpr Duration kMinLost = 2s;  ///< A predecessor silent for longer, and for 4 periods, is lost.

  struct Inputs {
    const PeerTable& peers;
    /// Position of this robot, map frame, m; nothing while localisation is not initialised.
    std::function<std::optional<Eigen::Vector3d>()> place{};
    NotifyHolder notify_holder{};
    /// Whether no known obstacle covers a place, map frame, m. Empty: each is free.
    std::function<bool(const Eigen::Vector2d&)> free{};
  };
  enum class State : std::uint8_t {
    forming,    ///< The predecessor has not spoken for this convoy yet, or the path is not known up to here.
    following,  ///< Drives along the path.
    waiting,    ///< The gap is as wanted, and the predecessor stands.
    lost,       ///< The predecessor is silent: drives on to the end of the known path.
    ended,      ///< The leader left.
  };

  Convoy(ConvoyParams params, Inputs inputs) : params_(std::move(params)), inputs_(std::move(inputs)) {}

  struct Role {
    ConvoyOrder order{};
    std::size_t index{};  ///< Of this robot; 0: it leads.
    bool left{};
  };

  /// Takes a place in a convoy. Errors: bad_argument (this robot is not in the order, an order of one robot
  /// or with a name twice, or this robot is in the convoy of another leader).
  Result<void> start(const ConvoyOrder& order);
  /// Leaves the convoy, and says so from now on. Errors: not_in_convoy.
  Result<void> leave();
  const std::optional<Role>& role() const { return role_; }
  /// Restores a place after a restart, or after a start() that was refused. A leader then learns its path
  /// from its followers.
  void set_role(std::optional<Role> role);

  bool in() const { return role_ && !role_->left; }
  bool leads() const { return in() && role_->index == 0; }
  bool follows() const { return in() && role_->index > 0; }
  /// The names of the robots that are in the convoy, in their order; empty: this robot is in none.
  std::vector<std::string> order() const;

  /// The same without this robot.
  std::vector<std::string> others() const;

  // Conditions of the mode convoy_follow.
  /// Whether the predecessor was heard lately, and the leader did not leave.
  bool leader_known(Time now) const;
  /// Whether the predecessor has no other order for this convoy.
  bool order_agrees() const;

  /// Takes in what the other members said, and the robot's own motion. Call it at 20 Hz.
  void tick(Time now);
  State state() const { return state_; }
  /// What keeps a follower from following at all, as text for its operator; empty: nothing does.
  std::string hindrance(Time now) const;
  /// The robot cannot stand at the place: another one beside it is next.
  void target_refused();
  /// The place to drive to, map frame, m; nothing: stand.
  const std::optional<Eigen::Vector3d>& target() const { return target_; }
  /// Limit of the robot's speed, m/s: the leader's in every mode but manual, and a follower's.
  double speed_limit(bool following) const { return following ? follow_speed_ : leader_limit_; }
  /// What this robot says of its place; nothing: it is in no convoy. `seq`: number of the beacon.
  std::optional<ConvoyPart> part(std::uint32_t seq) const;

 private:
  struct Member {
    std::string name{};
    bool spoke{};  ///< It said that it is in this convoy.
    bool left{};
    std::optional<ConvoyPart> part{};  ///< The last one of this convoy.
    double speed{};                    ///< m/s
    double length{};                   ///< In m; 0: unknown.
    double max_speed{};                ///< In m/s; 0: unknown.
    Time heard{};
    Duration period{1s};
  };
  void hear(Member& member);
  /// Takes in points of the path.
  void learn(const Member& member, Time now);
  void record(const Eigen::Vector3d& place, Time now);
  /// Finds this robot on the path; false: it is far away from it.
  bool locate(const Eigen::Vector3d& place);
  bool halts(const Member& ahead, Time now) const;
  bool misses_path(const Member& ahead) const;
  const Member* predecessor() const;
  void lead(Time now);
  void follow(Time now);
  /// Chooses the next place before `reach`; the robot is to stop at `stop`, both along the path, m. `stands`:
  /// neither of them moves.
  void choose_target(double stop, double reach, bool stands);
  double gap_to(const Member& ahead, Time now) const;
  /// A place of the path, or one beside it where the path leads through an obstacle.
  Eigen::Vector3d beside(const Eigen::Vector3d& place);
  std::uint32_t wanted() const;

  ConvoyParams params_;
  Inputs inputs_;
  std::optional<Role> role_{};
  std::vector<Member> members_{};  ///< In the order; this robot's own entry is not used.
  nav::Trail trail_{};
  nav::Governor governor_{};
  std::optional<Time> joined_{};  ///< First tick with this place.
  bool rejoins_{};                ///< A leader that was restarted learns the path from its followers.
  std::vector<Eigen::Vector3d> unrecorded_{};  ///< Where it was meanwhile.
  std::optional<Time> misfit_since_{};         ///< The predecessor sends points that do not fit.
  std::optional<double> along_{};              ///< Position of this robot on the path, m.
  double gap_{-1.0};
  State state_{State::forming};
  std::optional<double> target_along_{};
  std::optional<Eigen::Vector3d> target_{};
  std::size_t aside_{};                 ///< First of kAside to try.
  std::optional<double> refused_at_{};  ///< Its position when a place was refused, m.
  double follow_speed_{std::numeric_limits<double>::infinity()};
  double leader_limit_{std::numeric_limits<double>::infinity()};
  bool lost_reported_{}, split_reported_{};
  std::optional<Time> governed_{};
};

}  // namespace adit::agent

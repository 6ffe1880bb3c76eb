// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"
#include "nav/right_of_way/corridor.hpp"
#include "robot_agent/common/notice.hpp"
#include "robot_agent/discovery/peer_table.hpp"

namespace adit::agent {

/// Right of way between robots, by what each one drives for; the higher one passes.
enum class Rank : std::uint8_t { none, holds = 1, explores = 2, drives = 3, convoy = 5, by_hand = 6 };

struct RightOfWayParams {
  std::string robot{};       ///< Name of this robot.
  double length{}, width{};  ///< Of this robot, m.
  double max_speed{};        ///< m/s
  bool can_clear{};          ///< It has a router, and stays on the ground.
};

/// Decides which of two robots passes where both do not fit, and makes way for the other one.
///
/// A robot whose route leads through another one asks it, in its beacon, to make way; where both rank alike,
/// the one whose name comes first passes. The other one moves only if its holder allowed it (rule 8) and its
/// own position is in the asked corridor: it drives to a place beside it, in the mode `get_out`, waits until
/// the asker has passed, and resumes what it did. A robot that makes way asks, with the rank of the robot
/// for which it does, those in its own way. One that finds no place says so; the asker then makes way for it.
/// Runs on the command strand; bounded by the number of peers.
class RightOfWay {
 public:
  static constexpr Duration kHeard = 3s;           ///< An older beacon says nothing of where a robot is.
  static constexpr Duration kAskTimeout = 4500ms;  ///< An ask that is not renewed for longer has ended.
  static constexpr Duration kLongest = 90s;        ///< Longest time that a robot makes way.
  static constexpr Duration kRefused = 10s;        ///< How long the answer `cannot` is repeated.
  static constexpr Duration kBlocked = 8s;         ///< A way that is blocked for longer leads nowhere.
  static constexpr Duration kPersists = 1s;        ///< A robot must be in the way for so long.
  static constexpr Duration kReportAfter = 3s;     ///< How long, until the operator is notified.
  static constexpr Duration kWaits = 10s;     ///< Longest wait for the answer of a robot that may make way.
  static constexpr double kStands = 0.1;      ///< Slower is standing, m/s.
  static constexpr double kLookAhead = 20.0;  ///< m
  static constexpr double kMargin = 0.3;      ///< Between two robots that pass each other, m.
  static constexpr double kDistance = 2.0;    ///< From a robot that makes way, outline to outline, m.

  /// What this robot does now. Map frame, m.
  struct Own {
    std::optional<Pose2> pose{};
    std::string_view mode{"hold"};
    bool stopped{};
    bool drives{};                         ///< Its mode has a goal that is not reached, and runs.
    bool convoy{};                         ///< It is in a convoy.
    std::vector<std::string> members{};    ///< The other robots of its convoy.
    std::vector<Eigen::Vector2d> route{};  ///< The way ahead, from the robot on; empty: unknown.
    bool blocked{}, arrived{};             ///< Progress of `get_out`.
  };
  /// Finds a place outside the corridor; `asker`: the robot that must not be passed. Calls `done` once, or
  /// never if the odometry jumped.
  using FindPlace = std::function<void(const nav::Corridor& corridor, const std::string& asker,
                                       std::function<void(std::optional<Eigen::Vector2d>)> done)>;
  struct Outputs {
    FindPlace find_place{};
    /// Enters `get_out`. Errors: the first condition that does not hold.
    std::function<Result<void>(Time)> clear_way{};
    std::function<void(Time)> resume{};  ///< Leaves `get_out` for the mode before it.
    NotifyHolder notify_holder{};
  };

  RightOfWay(RightOfWayParams params, const PeerTable& peers, Outputs outputs)
      : params_(std::move(params)), peers_(peers), outputs_(std::move(outputs)) {}

  /// Allows the robot to make way, or no longer. Errors: not_supported.
  Result<void> allow(bool allowed, Time now);
  bool allowed() const { return allowed_; }
  /// The permission sleeps from a software stop until the holder's first request after the reset.
  bool asleep() const { return asleep_; }
  void restore(bool allowed, bool asleep) {
    allowed_ = allowed && params_.can_clear;
    asleep_ = asleep;
  }
  void stopped();
  /// The last software stop was cleared. What was requested before moves nothing.
  void reset() { asleep_ = allowed_; }
  void holder_requested() { asleep_ = false; }
  void holder_changed();

  /// Takes in what the others said. Call it at 5 Hz to 20 Hz.
  void tick(const Own& own, Time now);

  /// Condition of `get_out`: this robot makes way.
  bool clears() const { return clearing_.has_value(); }
  /// The place to drive to, map frame, m.
  std::optional<Eigen::Vector2d> place() const;
  std::string yields_to() const { return clearing_ ? clearing_->root : std::string{}; }
  /// Limit of the robot's speed before a robot that makes way, m/s.
  double speed_limit() const { return speed_limit_; }
  /// Whether an encounter goes on, for the rate of the beacons.
  bool in_encounter() const { return clearing_ || !asked_.empty(); }
  /// What a route across that robot costs, m, beside its length.
  double cost_of(const Peer& peer) const;

  /// Writes this robot's part of a beacon.
  void say(TeamBeacon& beacon) const;

 private:
  /// The claim to pass: the higher rank, then the earlier name.
  struct Claim {
    std::uint8_t rank{};
    std::string root{};
    bool outranks(const Claim& other) const {
      return rank != other.rank ? rank > other.rank : root < other.root;
    }
  };
  struct Clearing {
    std::string asker{}, root{};
    std::uint8_t rank{};
    Eigen::Vector2d place{0.0, 0.0}, from{0.0, 0.0};
    bool held{};  ///< It was in hold before.
    Time since{}, heard{}, looked{};
    std::optional<Time> blocked_since{};
    bool must_change{};  ///< The place is of no use.
  };
  struct Refusal {
    std::string root{};
    Reason reason{};
    Time until{};
  };
  /// A robot that was asked, and the places where it was in the way.
  struct Asked {
    std::string robot{};
    std::vector<Eigen::Vector2d> spots{};
    Time since{};
  };
  /// The first robot on the way ahead.
  struct Blocker {
    const Peer* peer{};
    double along{};  ///< m
  };

  Claim claim(const Own& own) const;
  static Claim claim(const TeamBeacon& beacon);
  static bool makes_way(const TeamBeacon& beacon);
  static bool refuses(const TeamBeacon& beacon, const std::string& root);
  bool fresh(const Peer& peer, Time now) const;
  std::optional<Blocker> blocker(const Own& own, Time now) const;
  void ask_others(const Own& own, Time now);
  void keep_asked(const Own& own, Time now);
  void keep_distance(const Own& own, const Blocker& before, Time now);
  void watch_wall(const Peer* wall, Time now);
  void answer_others(const Own& own, Time now);
  void find(const Own& own, const Peer& asker, Time now);
  void found_again(const std::optional<Eigen::Vector2d>& place, const Eigen::Vector2d& from, Time now);
  void clear(const Own& own, Time now);
  void refuse(const std::string& root, Reason reason, Time now);
  bool has_refused(const std::string& root) const;
  void end(Time now);
  /// Whether the outline of this robot is within `margin` metres of the asked corridor.
  bool in_corridor(const Own& own, const YieldAsk& ask, double margin) const;

  RightOfWayParams params_;
  const PeerTable& peers_;
  Outputs outputs_;
  bool allowed_{}, asleep_{}, could_{};
  Claim claim_{};
  std::optional<Clearing> clearing_{};
  std::vector<Refusal> refusals_{};
  std::uint64_t search_{};                ///< Number of the search for a place that counts.
  std::optional<Time> searches_since_{};  ///< A search is under way.
  std::vector<Asked> asked_{};
  std::vector<Eigen::Vector2d> route_{};
  std::string blocked_by_{};
  Time blocked_since_{};
  std::string reported_wall_{};
  std::optional<Time> wall_gone_{};
  double speed_limit_{std::numeric_limits<double>::infinity()};
};

}  // namespace adit::agent

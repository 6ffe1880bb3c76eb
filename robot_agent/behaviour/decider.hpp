#pragma once
#include <memory>
#include <set>
#include <string>

#include "core/bt/tree.hpp"
#include "robot_agent/behaviour/mode_table.hpp"

namespace adit::agent {

/// What the behaviour tree decided in a tick.
struct Decision {
  const ModeRow* mode{};        ///< never null
  bool runs{};                  ///< its source may pass; false: the mode stays, paused
  Reason reason{Reason::none};  ///< the first condition of the mode asked for that failed
};

/// Runs the robot's behaviour tree (config/trees/robot.xml). Leaves: the conditions of the mode table by
/// name, `Requested mode=""`, and the two ways of deciding, `Run mode=""` and `Pause mode=""`.
class Decider {
 public:
  /// Errors: of the file, with its line; not_supported when a mode of the table that is not optional appears
  /// nowhere in the tree.
  static Result<std::unique_ptr<Decider>> load(const std::string& tree_file);
  static Result<std::unique_ptr<Decider>> load_text(const std::string& xml);
  Decider(const Decider&) = delete;
  Decider& operator=(const Decider&) = delete;

  /// One tick. A tree that decides nothing, or fails, holds.
  Decision decide(std::string_view requested, const Facts& facts, Time now);
  /// The tree has a Run for that mode.
  bool installed(const ModeRow& row) const { return modes_.contains(row.name); }
  /// What a leaf threw in the last tick; empty: nothing.
  const std::string& error() const { return error_; }

 private:
  Decider() = default;
  Result<bt::Registry> registry();
  static Result<std::unique_ptr<Decider>> finish(std::unique_ptr<Decider> decider, Result<bt::Tree> tree);
  bt::NodeStatus choose(bt::Leaf& leaf, bool runs);

  bt::Tree tree_{};
  std::set<std::string, std::less<>> modes_{};  ///< that the tree runs
  std::string_view requested_{};
  Facts facts_{};
  Decision decision_{};
  std::string error_{};
};

}  // namespace adit::agent

// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/decider.hpp"

#include "robot_agent/behaviour/tree_check.hpp"

namespace adit::agent {
namespace {

bt::NodeStatus status(bool holds) { return holds ? bt::NodeStatus::success : bt::NodeStatus::failure; }

}  // namespace

Result<bt::Registry> Decider::registry() {
  bt::Registry leaves;
  for (const Condition& condition : table_.conditions()) {
    const auto added = leaves.add_condition(std::string(condition.leaf), [this, condition](bt::Leaf&) {
      const bool holds = condition.holds(facts_);
      if (!holds) note_failure(condition);
      return status(holds);
    });
    if (!added) return added.error();
  }
  // A leaf that is a function of the mode in its port; it fails if the table has none of that name.
  const auto of_mode = [this](bool (Decider::*leaf)(const ModeRow&)) {
    return [this, leaf](bt::Leaf& node) {
      const auto mode = node.input<std::string>("mode");
      const ModeRow* row = mode ? table_.find(*mode) : nullptr;
      return status(row && (this->*leaf)(*row));
    };
  };
  const bt::Ports ports{bt::required_input("mode", bt::PortType::text)};
  auto added = leaves.add_condition("Requested", of_mode(&Decider::is_requested), ports);
  if (added) added = leaves.add_action("Run", of_mode(&Decider::run), ports);
  if (added) added = leaves.add_action("Pause", of_mode(&Decider::pause), ports);
  if (added) added = leaves.add_action("Mode", of_mode(&Decider::run_or_pause), ports);
  if (!added) return added.error();
  return leaves;
}

bool Decider::run_or_pause(const ModeRow& row) {
  if (!is_requested(row)) return false;
  const Condition* ends = row.ended_by(facts_);
  const Condition* failed = ends ? ends : row.paused_by(facts_);
  if (failed) note_failure(*failed);
  return !ends && choose(row, !failed);
}

bool Decider::choose(const ModeRow& row, bool runs) {
  decision_.mode = &row;
  decision_.runs = runs;
  return true;
}

void Decider::note_failure(const Condition& failed) {
  if (decision_.reason == Reason::none) decision_.reason = failed.failure(facts_);
}

Result<std::unique_ptr<Decider>> Decider::make(
    const ModeTable& table, const std::function<Result<bt::Tree>(const bt::Registry&)>& load) {
  std::unique_ptr<Decider> decider(new Decider(table));
  const auto leaves = decider->registry();
  if (!leaves) return leaves.error();
  auto tree = load(*leaves);
  if (!tree) return tree.error();
  decider->tree_ = std::move(*tree);
  decider->tree_.for_each([&](const bt::TreeNode& node, std::size_t) {
    const auto mode = node.config().ports.find("mode");
    if ((node.id() == "Mode" || node.id() == "Run") && mode != node.config().ports.end())
      decider->modes_.insert(mode->second);
  });
  decider->tree_.on_error([d = decider.get()](const bt::TreeNode& node, std::string_view what) {
    d->error_ = node.name() + ": " + std::string(what);
  });
  return decider;
}

Result<std::unique_ptr<Decider>> Decider::checked(Result<std::unique_ptr<Decider>> decider) {
  if (!decider) return decider;
  if (const auto agrees = check_tree((*decider)->tree_, (*decider)->table_); !agrees) return agrees.error();
  return decider;
}

Result<std::unique_ptr<Decider>> Decider::load_unchecked(const std::string& tree_file,
                                                         const ModeTable& table) {
  return make(table, [&](const bt::Registry& leaves) { return bt::load_tree_file(leaves, tree_file); });
}

Result<std::unique_ptr<Decider>> Decider::load(const std::string& tree_file, const ModeTable& table) {
  return checked(load_unchecked(tree_file, table));
}

Result<std::unique_ptr<Decider>> Decider::load_text(const std::string& xml, const ModeTable& table) {
  return checked(make(table, [&](const bt::Registry& leaves) { return bt::load_tree_text(leaves, xml); }));
}

std::unique_ptr<Decider> Decider::refused(const Error& why, const ModeTable& table) {
  std::unique_ptr<Decider> decider(new Decider(table));
  decider->refusal_ = why.text;
  return decider;
}

Decision Decider::decide(std::string_view requested, const Facts& facts, Time now) {
  const ModeRow* hold = &table_.hold();
  if (tree_.empty()) return {hold, false, Reason::tree_refused};
  requested_ = requested;
  facts_ = facts;
  decision_ = {hold, false, Reason::none};
  error_.clear();
  const bt::NodeStatus result = tree_.tick(now);
  if (result == bt::NodeStatus::failure) decision_ = {hold, false, Reason::internal};
  return decision_;
}

}  // namespace adit::agent

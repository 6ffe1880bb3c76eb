#include "robot_agent/behaviour/decider.hpp"

#include <algorithm>

namespace adit::agent {
namespace {

bt::NodeStatus status(bool holds) { return holds ? bt::NodeStatus::success : bt::NodeStatus::failure; }

// The modes that the tree runs. Every mode that is not optional must be reachable: a row without a subtree
// would be refused in silence by the tree.
Result<std::set<std::string, std::less<>>> modes_of(const bt::Tree& tree) {
  std::set<std::string, std::less<>> runs;
  tree.for_each([&](const bt::Node& node, std::size_t) {
    if (node.id() != "Run") return;
    const auto mode = node.config().ports.find("mode");
    if (mode != node.config().ports.end()) runs.insert(mode->second);
  });
  for (const ModeRow& row : mode_table())
    if (!row.optional && !runs.contains(row.name))
      return Error{Reason::not_supported, "the behaviour tree has no Run for mode " + std::string(row.name)};
  for (const std::string& mode : runs)
    if (!find_mode(mode))
      return Error{Reason::mode_unknown, "the behaviour tree runs the unknown mode " + mode};
  return runs;
}

}  // namespace

Result<bt::Registry> Decider::registry() {
  bt::Registry leaves;
  const bt::Ports mode{bt::required_input("mode", bt::PortType::text)};
  for (const Condition& condition : all_conditions()) {
    const auto added = leaves.add_condition(std::string(condition.leaf), [this, condition](bt::Leaf&) {
      const bool holds = condition.holds(facts_);
      if (!holds && decision_.reason == Reason::none) decision_.reason = condition.reason;
      return status(holds);
    });
    if (!added) return added.error();
  }
  const auto requested = leaves.add_condition(
      "Requested",
      [this](bt::Leaf& leaf) {
        const auto asked = leaf.input<std::string>("mode");
        return status(asked && *asked == requested_);
      },
      mode);
  if (!requested) return requested.error();
  const auto run = leaves.add_action(
      "Run", [this](bt::Leaf& leaf) { return choose(leaf, true); }, mode);
  if (!run) return run.error();
  const auto pause = leaves.add_action(
      "Pause", [this](bt::Leaf& leaf) { return choose(leaf, false); }, mode);
  if (!pause) return pause.error();
  return leaves;
}

bt::NodeStatus Decider::choose(bt::Leaf& leaf, bool runs) {
  const auto mode = leaf.input<std::string>("mode");
  const ModeRow* row = mode ? find_mode(*mode) : nullptr;
  if (!row) return bt::NodeStatus::failure;
  decision_.mode = row;
  decision_.runs = runs;
  return bt::NodeStatus::success;
}

Result<std::unique_ptr<Decider>> Decider::load(const std::string& tree_file) {
  std::unique_ptr<Decider> decider(new Decider);
  const auto leaves = decider->registry();
  if (!leaves) return leaves.error();
  return finish(std::move(decider), bt::load_tree_file(*leaves, tree_file));
}

Result<std::unique_ptr<Decider>> Decider::load_text(const std::string& xml) {
  std::unique_ptr<Decider> decider(new Decider);
  const auto leaves = decider->registry();
  if (!leaves) return leaves.error();
  return finish(std::move(decider), bt::load_tree_text(*leaves, xml));
}

Result<std::unique_ptr<Decider>> Decider::finish(std::unique_ptr<Decider> decider, Result<bt::Tree> tree) {
  if (!tree) return tree.error();
  auto modes = modes_of(*tree);
  if (!modes) return modes.error();
  decider->modes_ = std::move(*modes);
  decider->tree_ = std::move(*tree);
  decider->tree_.on_error([d = decider.get()](const bt::Node& node, std::string_view what) {
    d->error_ = node.name() + ": " + std::string(what);
  });
  return decider;
}

Decision Decider::decide(std::string_view requested, const Facts& facts, Time now) {
  const ModeRow* hold = &mode_table().front();
  requested_ = requested;
  facts_ = facts;
  decision_ = {hold, false, Reason::none};
  error_.clear();
  const bt::NodeStatus result = tree_.tick(now);
  if (result == bt::NodeStatus::failure) decision_ = {hold, false, Reason::internal};
  return decision_;
}

}  // namespace adit::agent

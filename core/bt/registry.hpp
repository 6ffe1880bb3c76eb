#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/bt/leaf.hpp"

namespace adit::bt {

using NodeFactory = std::function<std::unique_ptr<TreeNode>(NodeConfig)>;

/// What the loader knows about a kind of node.
struct Manifest {
  std::string id{};
  NodeKind kind{NodeKind::action};
  Ports ports{};
  std::size_t min_children{0};
  std::size_t max_children{0};
  NodeFactory make{};
  bool builtin{false};
};

/// The kinds of node that a tree may be made of: the built-in ones of BehaviorTree.CPP, and leaves that
/// are registered by name. Copyable; a tree keeps nothing of it but what the factories captured.
class Registry {
 public:
  /// With the built-in nodes.
  Registry();

  /// Each answers Reason::in_use when the id is taken.
  Result<void> add_action(std::string id, LeafFunction function, Ports ports = {});
  Result<void> add_condition(std::string id, LeafFunction function, Ports ports = {});
  Result<void> add_stateful(std::string id, StatefulFactory factory, Ports ports = {});
  /// A number's name for scripts and Switch nodes.
  void add_enum(std::string name, std::int64_t value) { enums_[std::move(name)] = value; }

  /// Leaves of unknown ids are made by this factory instead of being an error; any attribute is a port of
  /// theirs. For dry runs.
  void accept_unknown_leaves(StatefulFactory factory) { unknown_ = std::move(factory); }
  const StatefulFactory& unknown_leaves() const { return unknown_; }

  /// The manifest of that id, or nullptr.
  const Manifest* find(std::string_view id) const;
  const Enums& enums() const { return enums_; }
  /// Used by the tables of built-in nodes.
  Result<void> add(Manifest manifest);

 private:
  std::map<std::string, Manifest, std::less<>> manifests_{};
  Enums enums_{};
  StatefulFactory unknown_{};
};

}  // namespace adit::bt

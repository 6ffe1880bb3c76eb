// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/bt/leaf.hpp"

namespace adit::bt {

using NodeFactory = std::function<std::unique_ptr<TreeNode>(NodeConfig)>;

/// Description of a kind of node for the loader.
struct Manifest {
  std::string id{};
  NodeKind kind{NodeKind::action};
  Ports ports{};
  std::size_t min_children{0};
  std::size_t max_children{0};
  NodeFactory make{};
  bool builtin{false};
};

/// The kinds of node that a tree can contain: the built-in ones of BehaviorTree.CPP, and leaves registered by
/// name. Copyable; a tree refers to nothing of it except what the factories captured.
class Registry {
 public:
  /// Creates a registry with the built-in nodes.
  Registry();

  /// Registers a leaf. Error in_use when the id is taken.
  Result<void> add_action(std::string id, LeafFunction function, Ports ports = {});
  Result<void> add_condition(std::string id, LeafFunction function, Ports ports = {});
  Result<void> add_stateful(std::string id, StatefulFactory factory, Ports ports = {});
  /// Adds a name for a number, for scripts and Switch nodes.
  void add_enum(std::string name, std::int64_t value) { enums_[std::move(name)] = value; }

  /// Makes this factory create leaves of unknown ids, which are otherwise an error; each attribute is a port
  /// of such a leaf. For dry runs.
  void accept_unknown_leaves(StatefulFactory factory) { unknown_ = std::move(factory); }
  const StatefulFactory& unknown_leaves() const { return unknown_; }

  /// Returns the manifest of that id, or nullptr.
  const Manifest* find(std::string_view id) const;
  const Enums& enums() const { return enums_; }
  /// Registers a manifest; the tables of built-in nodes use it.
  Result<void> add(Manifest manifest);

 private:
  std::map<std::string, Manifest, std::less<>> manifests_{};
  Enums enums_{};
  StatefulFactory unknown_{};
};

}  // namespace adit::bt

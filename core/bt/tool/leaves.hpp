// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/bt/registry.hpp"

namespace adit::bt::tool {

/// Scripted results of one leaf: each visit uses one, and the last one repeats for ever.
struct Script {
  std::vector<NodeStatus> answers{};
  std::size_t next{0};
  bool used{false};  ///< A leaf of the tree has this name.
};

/// State that the leaves of a dry run share: their scripts, and the events since the trace was last read.
struct DryRun {
  std::map<std::string, Script, std::less<>> scripts{};
  std::vector<std::string> ticked{};
  std::vector<std::string> halted{};
};

/// Reads LEAVES.yaml: "Name: [RUNNING, SUCCESS]" for each leaf, by its name attribute or its ID. The error's
/// text is "file:line: what was expected".
Result<std::map<std::string, Script, std::less<>>> read_leaves(const std::string& path);

/// Creates a registry in which every unknown leaf plays its script, or succeeds.
Registry dry_registry(std::shared_ptr<DryRun> run);

}  // namespace adit::bt::tool

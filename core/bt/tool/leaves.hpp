#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/bt/registry.hpp"

namespace adit::bt::tool {

/// One leaf's answers: one is used per visit, the last one for ever.
struct Script {
  std::vector<NodeStatus> answers{};
  std::size_t next{0};
  bool used{false};  ///< a leaf of the tree has this name
};

/// What the leaves of a dry run share: their scripts, and what happened since the trace was last taken.
struct DryRun {
  std::map<std::string, Script, std::less<>> scripts{};
  std::vector<std::string> ticked{};
  std::vector<std::string> halted{};
};

/// Reads LEAVES.yaml: "Name: [RUNNING, SUCCESS]" for each leaf, by its name attribute or its ID. The error's
/// text is "file:line: what was expected".
Result<std::map<std::string, Script, std::less<>>> read_leaves(const std::string& path);

/// A registry in which every unknown leaf plays its script, or succeeds.
Registry dry_registry(std::shared_ptr<DryRun> run);

}  // namespace adit::bt::tool

// SPDX-License-Identifier: Apache-2.0
#include "core/bt/tool/leaves.hpp"

#include <yaml-cpp/yaml.h>

#include <fstream>

namespace adit::bt::tool {

namespace {

Error wrong(const std::string& path, const YAML::Mark& mark, const std::string& text, Reason reason) {
  return {reason, path + ":" + std::to_string(mark.line + 1) + ": " + text};
}

class DryLeaf : public StatefulLeaf {
 public:
  DryLeaf(std::shared_ptr<DryRun> run, Script* script) : run_(std::move(run)), script_(script) {}

  NodeStatus on_start(Leaf& leaf) override { return visit(leaf); }
  NodeStatus on_running(Leaf& leaf) override { return visit(leaf); }
  void on_halted(Leaf& leaf) override {
    if (script_) run_->halted.push_back(leaf.name());
  }

 private:
  NodeStatus visit(Leaf& leaf) {
    if (!script_) return NodeStatus::success;
    run_->ticked.push_back(leaf.name());
    const NodeStatus answer = script_->answers[script_->next];
    if (script_->next + 1 < script_->answers.size()) ++script_->next;
    return answer;
  }
  std::shared_ptr<DryRun> run_;
  Script* script_;
};

}  // namespace

Result<std::map<std::string, Script, std::less<>>> read_leaves(const std::string& path) {
  std::map<std::string, Script, std::less<>> scripts;
  if (!std::ifstream(path)) return Error{Reason::cannot_read, path + ": cannot be read"};
  try {
    const YAML::Node root = YAML::LoadFile(path);
    if (root.IsNull()) return scripts;
    if (!root.IsMap())
      return wrong(path, root.Mark(), "expected 'Name: [RUNNING, SUCCESS]' lines", Reason::wrong_type);
    for (const auto& entry : root) {
      const auto leaf_name = entry.first.as<std::string>();
      const YAML::Node& list = entry.second;
      if (scripts.contains(leaf_name)) {
        return wrong(path, entry.first.Mark(), "leaf '" + leaf_name + "' is there twice", Reason::syntax);
      }
      if (!list.IsSequence() || list.size() == 0) {
        return wrong(path, entry.first.Mark(),
                     "leaf '" + leaf_name + "' needs a list such as [RUNNING, SUCCESS]", Reason::wrong_type);
      }
      Script script;
      for (const auto& item : list) {
        const auto status = item.IsScalar() ? status_from_name(item.Scalar()) : std::nullopt;
        if (!status || *status == NodeStatus::idle) {
          return wrong(path, item.Mark(),
                       "leaf '" + leaf_name + "': expected RUNNING, SUCCESS, FAILURE or SKIPPED",
                       Reason::wrong_type);
        }
        script.answers.push_back(*status);
      }
      scripts.emplace(leaf_name, std::move(script));
    }
  } catch (const YAML::Exception& error) {
    return wrong(path, error.mark, "not well-formed YAML: " + error.msg, Reason::syntax);
  }
  return scripts;
}

Registry dry_registry(std::shared_ptr<DryRun> run) {
  Registry registry;
  registry.accept_unknown_leaves([run](const NodeConfig& config) {
    auto script = run->scripts.find(config.name);
    if (script == run->scripts.end()) script = run->scripts.find(config.id);
    Script* chosen = script == run->scripts.end() ? nullptr : &script->second;
    if (chosen) chosen->used = true;
    return std::make_unique<DryLeaf>(run, chosen);
  });
  return registry;
}

}  // namespace adit::bt::tool

// SPDX-License-Identifier: Apache-2.0
#include "core/bt/tool/run.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "core/bt/tool/leaves.hpp"
#include "core/bt/tree.hpp"

namespace adit::bt::tool {

namespace {

using Json = nlohmann::ordered_json;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& part : names) text += " " + part;
  return text;
}

void print(const RunOptions& options, const Tree& tree, const DryRun& dry, int tick, NodeStatus answer) {
  Json nodes = Json::object();
  tree.for_each([&](const TreeNode& node, std::size_t) {
    if (node.named() && node.status() != NodeStatus::idle) nodes[node.name()] = name(node.status());
  });
  // Bytes of a name that are not UTF-8 are replaced; otherwise the JSON library would throw.
  const auto text_of = [](const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  if (options.json) {
    const Json line{{"tick", tick},
                    {"status", name(answer)},
                    {"ticked", dry.ticked},
                    {"halted", dry.halted},
                    {"nodes", nodes}};
    std::cout << text_of(line) << "\n";
    return;
  }
  std::cout << "tick " << tick << "  " << name(answer) << "  ticked:" << joined(dry.ticked);
  if (!dry.halted.empty()) std::cout << "  halted:" << joined(dry.halted);
  std::cout << "  nodes: " << text_of(nodes) << "\n";
}

}  // namespace

int run(const RunOptions& options) {
  auto dry = std::make_shared<DryRun>();
  if (!options.leaves.empty()) {
    auto scripts = read_leaves(options.leaves);
    if (!scripts) {
      std::cerr << "tree: " << scripts.error().text << "\n";
      return 1;
    }
    dry->scripts = std::move(*scripts);
  }
  auto tree = load_tree_file(dry_registry(dry), options.file, options.tree);
  if (!tree) {
    std::cerr << "tree: " << tree.error().text << "\n";
    return 1;
  }
  for (const auto& [leaf, script] : dry->scripts) {
    if (!script.used) std::cerr << "tree: note: no leaf '" << leaf << "' in the tree\n";
  }
  int tick = 0;
  tree->on_error([&](const TreeNode& node, std::string_view what) {
    std::cerr << "tree: tick " << tick << ": " << node.config().file << ":" << node.config().line << ": '"
              << node.name() << "': " << what << "\n";
  });
  for (tick = 1; tick <= options.ticks; ++tick) {
    dry->ticked.clear();
    dry->halted.clear();
    const Time now{std::chrono::milliseconds(options.tick_ms) * (tick - 1)};
    const NodeStatus answer = tree->tick(now);
    print(options, *tree, *dry, tick, answer);
  }
  return 0;
}

}  // namespace adit::bt::tool

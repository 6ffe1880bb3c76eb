// SPDX-License-Identifier: Apache-2.0
// tree: checks, draws and dry-runs behaviour trees.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "core/bt/draw.hpp"
#include "core/bt/tool/leaves.hpp"
#include "core/bt/tool/run.hpp"
#include "core/config/usage.hpp"
#include "robot_agent/behaviour/tree_check.hpp"

namespace {

using namespace adit::bt;

constexpr int kBadInput = 1;

constexpr const char* kFooter = R"(Examples:
  tree check config/trees/robot.xml
  tree draw config/trees/robot.xml
  tree draw config/trees/robot.xml --dot | dot -Tpng -o robot.png
  tree run config/trees/robot.xml --leaves leaves.yaml --ticks 20 --json

leaves.yaml scripts the results of leaves, by name or ID; one entry is used per visit, the last repeated:
  IsReady: [FAILURE, SUCCESS]
  Drive:   [RUNNING, RUNNING, SUCCESS]
Leaves that are neither built in nor scripted succeed.

A tree with leaves of a robot's (Mode, Run, Pause, Requested, a condition of a mode) is checked against the mode table as well, as the
robot does when it loads the tree.

Exit status: 0 done, 1 the tree or the leaves are wrong (file:line on stderr), 2 wrong usage.)";

int fail(const adit::Error& error) {
  std::cerr << "tree: " << error.text << "\n";
  return kBadInput;
}

int check(const std::string& file) {
  const Registry leaves = tool::dry_registry(std::make_shared<tool::DryRun>());
  const auto trees = check_tree_file(leaves, file);
  if (!trees) return fail(trees.error());
  const bool robots = std::any_of(trees->begin(), trees->end(), [&](const std::string& id) {
    const auto tree = load_tree_file(leaves, file, id);
    return tree && adit::agent::is_robot_tree(*tree);
  });
  if (robots)
    if (const auto checked = adit::agent::check_tree(file); !checked) return fail(checked.error());
  std::cout << file << ": ok,";
  for (const auto& id : *trees) std::cout << " " << id;
  std::cout << "\n";
  return 0;
}

int draw(const std::string& file, const std::string& id, bool dot) {
  const auto tree = load_tree_file(tool::dry_registry(std::make_shared<tool::DryRun>()), file, id);
  if (!tree) return fail(tree.error());
  std::cout << (dot ? draw_dot(*tree) : draw_text(*tree));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Checks, draws and dry-runs behaviour trees in the BehaviorTree.CPP v4 XML format.", "tree"};
  app.require_subcommand(1);
  app.footer(kFooter);
  std::string file, id;
  bool dot = false;
  tool::RunOptions options;

  auto* check_command =
      app.add_subcommand("check", "Check a file and every tree in it; errors with their line");
  check_command->add_option("FILE", file, "the tree's XML")->required();

  auto* draw_command = app.add_subcommand("draw", "Draw a tree as text");
  draw_command->add_option("FILE", file, "the tree's XML")->required();
  draw_command->add_flag("--dot", dot, "for Graphviz instead");
  draw_command->add_option("--tree", id, "ID of the tree [the main tree]");

  auto* run_command =
      app.add_subcommand("run", "Dry run: tick the tree with scripted leaves, one line a tick");
  run_command->add_option("FILE", options.file, "the tree's XML")->required();
  run_command->add_option("--leaves", options.leaves, "YAML with the results of leaves [all succeed]");
  run_command->add_option("--ticks", options.ticks, "how many ticks")
      ->check(adit::config::between(1, 1'000'000))
      ->capture_default_str();
  run_command->add_flag("--json", options.json, "one JSON object a tick");
  run_command
      ->add_option(
          "--tick-ms", options.tick_ms,
          "virtual time from one tick to the next, for Delay, Timeout and Sleep; it starts at 0 and is the "
          "only clock: a dry run never waits")
      ->check(adit::config::between(0, 3'600'000))
      ->capture_default_str();
  run_command->add_option("--tree", options.tree, "ID of the tree [the main tree]");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return adit::config::end_usage(app, error);
  }
  if (check_command->parsed()) return check(file);
  if (draw_command->parsed()) return draw(file, id, dot);
  return tool::run(options);
}

// SPDX-License-Identifier: Apache-2.0
#include "core/bt/xml/forest.hpp"

#include <algorithm>
#include <filesystem>

namespace adit::bt::xml {

namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMaxFiles = 64;

class Collector {
 public:
  explicit Collector(Forest& forest) : forest_(forest) {}

  void add(Element& root, const fs::path& folder) {
    if (root.tag != "root") fail(root, "the outermost element is <" + root.tag + ">, expected <root>");
    if (const auto* format = root.attribute("BTCPP_format"); format && *format != "4") {
      fail(root, "BTCPP_format is \"" + *format + "\", only \"4\" can be read", Reason::not_supported);
    }
    // As in BehaviorTree.CPP, included files come first.
    for (const auto& element : root.children) {
      if (element.tag == "include") include(element, folder);
    }
    bool model_seen = false;
    const bool single = std::count_if(root.children.begin(), root.children.end(),
                                      [](const Element& e) { return e.tag == "BehaviorTree"; }) == 1;
    for (auto& element : root.children) {
      if (element.tag == "BehaviorTree") {
        add_tree(element, single);
      } else if (element.tag == "TreeNodesModel") {
        if (model_seen) fail(element, "only one <TreeNodesModel> is allowed");
        model_seen = true;
        add_models(element);
      } else if (element.tag != "include") {
        fail(element, "<" + element.tag +
                          "> is not expected in <root>, only <BehaviorTree>, <include> and "
                          "<TreeNodesModel>");
      }
    }
  }

 private:
  void include(const Element& element, const fs::path& folder) {
    const auto* path = element.attribute("path");
    if (!path) fail(element, "<include> needs the attribute [path]", Reason::missing_key);
    if (element.attribute("ros_pkg"))
      fail(element, "[ros_pkg] of <include> is not supported", Reason::not_supported);
    const fs::path file = fs::path(*path).is_absolute() ? fs::path(*path) : folder / *path;
    std::error_code error;
    const std::string identity = fs::weakly_canonical(file, error).string();
    if (std::find(open_.begin(), open_.end(), identity) != open_.end()) {
      fail(element, "'" + *path + "' includes itself");
    }
    if (!seen_.insert(identity).second) return;  // Another include has already read this file.
    if (seen_.size() > kMaxFiles)
      fail(element, "more than " + std::to_string(kMaxFiles) + " files are included");
    Element root;
    try {
      root = parse(read_file(file.string()), file.string());
    } catch (const LoadError& problem) {
      if (problem.reason == Reason::cannot_read)
        fail(element, std::string("<include> ") + problem.what(), problem.reason);
      throw;
    }
    open_.push_back(identity);
    add(root, file.parent_path());
    open_.pop_back();
  }

  void add_tree(Element& element, bool single) {
    const auto* given = element.attribute("ID");
    if ((!given || given->empty()) && !single) {
      fail(element, "<BehaviorTree> needs the attribute [ID]: the file has several", Reason::missing_key);
    }
    const std::string id = given && !given->empty() ? *given : "BehaviorTree";
    if (const auto it = forest_.trees.find(id); it != forest_.trees.end()) {
      fail(element, "tree '" + id + "' is already defined in " + *it->second.file + ":" +
                        std::to_string(it->second.line));
    }
    forest_.order.push_back(id);
    forest_.trees.emplace(id, std::move(element));
  }

  void add_models(const Element& models) {
    for (const auto& model : models.children) {
      const auto* id = model.attribute("ID");
      if (!id)
        fail(model, "<" + model.tag + "> in <TreeNodesModel> needs the attribute [ID]", Reason::missing_key);
      if (model.tag != "SubTree") continue;
      auto& ports = forest_.models[*id];
      for (const auto& port : model.children) {
        if (port.tag != "input_port" && port.tag != "output_port" && port.tag != "inout_port") continue;
        const auto* name = port.attribute("name");
        if (!name) fail(port, "<" + port.tag + "> needs the attribute [name]", Reason::missing_key);
        const auto* fallback = port.attribute("default");
        ports.push_back({*name, fallback ? std::optional(*fallback) : std::nullopt});
      }
    }
  }

  Forest& forest_;
  std::set<std::string> seen_{};
  std::vector<std::string> open_{};
};

}  // namespace

Forest collect(Element root, const std::string& folder) {
  Forest forest;
  if (const auto* main = root.attribute("main_tree_to_execute")) forest.main = *main;
  Collector(forest).add(root, folder);
  root.children.clear();
  forest.root = std::move(root);
  if (forest.trees.empty()) fail(forest.root, "no <BehaviorTree> in it");
  return forest;
}

std::string main_tree(const Forest& forest, const std::string& wanted) {
  const std::string id = !wanted.empty() ? wanted : forest.main.value_or("");
  if (id.empty()) {
    if (forest.trees.size() == 1) return forest.order.front();
    fail(forest.root, "several trees: <root> needs the attribute [main_tree_to_execute]",
         Reason::missing_key);
  }
  if (forest.trees.contains(id)) return id;
  std::string known;
  for (const auto& tree : forest.order) known += (known.empty() ? "" : ", ") + tree;
  fail(forest.root, "no tree with ID '" + id + "', there are: " + known);
}

}  // namespace adit::bt::xml

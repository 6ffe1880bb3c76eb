// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "core/bt/tree.hpp"
#include "core/bt/xml/build.hpp"
#include "core/bt/xml/verify.hpp"

namespace adit::bt {

namespace {

/// Runs a loader step; any exception becomes the Error.
template <class Step>
auto guarded(const std::string& source, Step step) -> Result<decltype(step())> {
  try {
    return step();
  } catch (const xml::LoadError& error) {
    return Error{error.reason, error.what()};
  } catch (const std::exception& error) {
    return Error{Reason::internal, source + ": " + error.what()};
  }
}

std::string folder_of(const std::string& path) { return std::filesystem::path(path).parent_path().string(); }

}  // namespace

Result<Tree> load_tree_text(const Registry& registry, std::string_view text, const std::string& source,
                            const std::string& tree_id) {
  return guarded(source, [&] {
    const auto forest = xml::collect(xml::parse(text, source), folder_of(source));
    xml::verify(forest, registry);
    return TreeBuilder(forest, registry).build(xml::main_tree(forest, tree_id));
  });
}

Result<Tree> load_tree_file(const Registry& registry, const std::string& path, const std::string& tree_id) {
  const auto text = guarded(path, [&] { return xml::read_file(path); });
  if (!text) return text.error();
  return load_tree_text(registry, *text, path, tree_id);
}

Result<std::vector<std::string>> check_tree_file(const Registry& registry, const std::string& path) {
  return guarded(path, [&] {
    const auto forest = xml::collect(xml::parse(xml::read_file(path), path), folder_of(path));
    xml::verify(forest, registry);
    if (forest.main) (void)xml::main_tree(forest, "");
    for (const auto& id : forest.order) TreeBuilder(forest, registry).build(id);
    return forest.order;
  });
}

}  // namespace adit::bt

// SPDX-License-Identifier: Apache-2.0
#include "core/config/search.hpp"

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

namespace adit::config {
namespace fs = std::filesystem;

std::vector<std::string> search_path(const std::string& beside) {
  std::vector<std::string> path;
  const auto add = [&](const fs::path& folder) {
    std::error_code error;
    if (fs::is_directory(folder, error)) path.push_back(folder.lexically_normal().string());
  };
  if (!beside.empty()) {
    const fs::path parent = fs::path(beside).parent_path();
    add(parent.empty() ? fs::path(".") : parent);
  }
  if (const char* environment = std::getenv("ADIT_CONFIG")) {
    std::istringstream folders(environment);
    for (std::string folder; std::getline(folders, folder, ':');)
      if (!folder.empty()) add(folder);
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return path;
  // The path build/PRESET/bin/program is three folders below the root of the source tree.
  fs::path folder = program.parent_path();
  for (int up = 0; up < 4 && folder.has_relative_path(); ++up, folder = folder.parent_path()) {
    if (!fs::exists(folder / "config" / "platforms", error)) continue;
    add(folder / "config");
    add(folder / "data" / "maps");
    break;
  }
  const fs::path share = program.parent_path().parent_path() / "share" / "adit";
  add(share / "config");
  add(share / "maps");
  return path;
}

Result<std::string> find_file(const std::string& name, const std::string& beside) {
  std::error_code error;
  if (fs::path(name).is_absolute()) {
    if (fs::is_regular_file(name, error)) return name;
    return Error{Reason::cannot_read, name + ": no such file"};
  }
  const auto path = search_path(beside);
  std::string places;
  for (const std::string& folder : path) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file, error)) return file.string();
    places += (places.empty() ? "" : ", ") + folder;
  }
  return Error{Reason::cannot_read, name + ": no such file in " + (places.empty() ? "any folder" : places)};
}

Result<std::string> find_named(const std::string& folder, const std::string& name,
                               const std::string& beside) {
  if (name.ends_with(".yaml")) return find_file(name, beside);
  if (auto found = find_file(folder + "/" + name + ".yaml", beside)) return found;
  std::set<std::string> known;
  std::error_code error;
  // A range-for would throw at a folder that cannot be read completely.
  for (const std::string& place : search_path(beside))
    for (fs::directory_iterator it(fs::path(place) / folder, error), end; !error && it != end;
         it.increment(error))
      if (it->path().extension() == ".yaml") known.insert(it->path().stem().string());
  if (known.empty()) return find_file(folder + "/" + name + ".yaml", beside);
  std::string names;
  for (const std::string& each : known) names += (names.empty() ? "" : ", ") + each;
  return Error{Reason::cannot_read,
               "no '" + name + "' in config/" + folder + "; there are: " + names + " (or a file, NAME.yaml)"};
}

}  // namespace adit::config

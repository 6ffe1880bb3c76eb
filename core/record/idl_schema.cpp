// SPDX-License-Identifier: Apache-2.0
#include "core/record/idl_schema.hpp"

#include <cctype>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "core/record/idl_texts.hpp"

namespace adit::record {
namespace {

std::string uncommented(const std::string& line) { return line.substr(0, line.find("//")); }

/// Returns the name in `#include "name"`, or an empty text for another line.
std::string included(const std::string& line) {
  if (!line.starts_with("#include")) return {};
  const std::size_t first = line.find('"'), last = line.rfind('"');
  return first == std::string::npos || last == first ? std::string{}
                                                     : line.substr(first + 1, last - first - 1);
}

struct Index {
  Index() {
    for (const IdlText& file : idl_texts()) files.emplace(file.path, file.text);
    for (const auto& [path, text] : files) add_types(path, text);
  }

  /// Adds the structs by scoped name. Our IDL opens modules and structs by `word NAME {`, and braces nest.
  void add_types(const std::string& path, const std::string& text) {
    std::istringstream lines(text);
    std::vector<std::string> scope;
    std::string before, last;
    for (std::string line; std::getline(lines, line);) {
      line = uncommented(line);
      std::string word;
      const auto end_word = [&] {
        if (!word.empty()) before = std::exchange(last, std::exchange(word, {}));
      };
      for (const char c : line + "\n") {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '@') {
          word += c;
          continue;
        }
        end_word();
        if (c == '{') {
          std::string name;
          for (const std::string& part : scope) name += part + "::";
          if (before == "struct") types[name + last] = path;
          scope.push_back(last);
        } else if (c == '}' && !scope.empty()) {
          scope.pop_back();
        }
      }
    }
  }

  void append(const std::string& path, std::set<std::string>& seen, std::string& out) const {
    if (!seen.insert(path).second) return;
    std::istringstream lines(files.at(path));
    for (std::string line; std::getline(lines, line);) {
      const std::string name = included(line);
      const std::string beside = path.substr(0, path.rfind('/') + 1) + name;
      if (name.empty() && !line.starts_with('#'))  // Guards are not needed: each file comes once.
        out += line + "\n";
      else if (files.contains(beside))
        append(beside, seen, out);
      else if (files.contains(name))
        append(name, seen, out);
    }
  }

  std::map<std::string, std::string> files{};  ///< Text by path.
  std::map<std::string, std::string> types{};  ///< Path by scoped name.
};

std::string scoped_name(std::string_view dds_type) {
  std::string name(dds_type);
  // The contract's version is part of the DDS type name, but no module of the IDL.
  constexpr std::string_view family = "adit::radio::v";
  if (name.starts_with(family)) {
    const std::size_t end = name.find_first_not_of("0123456789", family.size());
    if (end != std::string::npos && end > family.size() && name.compare(end, 2, "::") == 0)
      name.erase(family.size() - 1, end + 2 - (family.size() - 1));
  }
  const std::size_t mangled = name.find("::dds_::");
  if (mangled == std::string::npos || !name.ends_with('_')) return name;
  name.pop_back();
  return name.replace(mangled, 8, "::");
}

}  // namespace

std::optional<IdlSchema> idl_schema(std::string_view dds_type) {
  static const Index index;  // Constant: the texts are part of the program.
  IdlSchema schema{scoped_name(dds_type), {}};
  const auto type = index.types.find(schema.name);
  if (type == index.types.end()) return std::nullopt;
  std::set<std::string> seen;
  index.append(type->second, seen, schema.text);
  return schema;
}

}  // namespace adit::record

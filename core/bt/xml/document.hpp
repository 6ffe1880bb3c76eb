// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

namespace adit::bt::xml {

struct Attribute {
  std::string name{};
  std::string value{};
};

/// One XML element with its position in the file.
struct Element {
  std::string tag{};
  std::vector<Attribute> attributes{};
  std::vector<Element> children{};
  std::shared_ptr<const std::string> file{};
  int line{0};

  /// Returns the attribute's value, or nullptr.
  const std::string* attribute(std::string_view name) const;
};

/// Exception inside the loader; its text names file and line.
struct LoadError : std::runtime_error {
  LoadError(Reason why, const std::string& text) : std::runtime_error(text), reason(why) {}
  Reason reason;
};
/// Throws LoadError with the text "file:12: text".
[[noreturn]] void fail(const Element& at, const std::string& text, Reason reason = Reason::syntax);

/// Parses a document; comments and texts between elements are ignored. Throws LoadError.
Element parse(std::string_view text, const std::string& file);
/// Reads a file of at most 4 MB. Throws LoadError.
std::string read_file(const std::string& path);

}  // namespace adit::bt::xml

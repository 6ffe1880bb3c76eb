// SPDX-License-Identifier: Apache-2.0
#include "core/bt/xml/document.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace adit::bt::xml {

namespace {

constexpr std::uintmax_t kMaxBytes = 4u << 20;

Element convert(const tinyxml2::XMLElement& source, const std::shared_ptr<const std::string>& file) {
  Element element;
  element.tag = source.Name();
  element.file = file;
  element.line = source.GetLineNum();
  for (const auto* a = source.FirstAttribute(); a; a = a->Next()) {
    if (element.attribute(a->Name()))
      fail(element, "attribute [" + std::string(a->Name()) + "] is given twice");
    element.attributes.push_back({a->Name(), a->Value()});
  }
  // The depth is bounded: tinyxml2 refuses more than 100 levels.
  for (const auto* child = source.FirstChildElement(); child; child = child->NextSiblingElement()) {
    element.children.push_back(convert(*child, file));
  }
  return element;
}

std::string explain(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "the file is empty, expected <root BTCPP_format=\"4\">";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is closed that is not open, or not closed";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested more than 100 deep";
    default:
      return std::string("not well-formed XML (") + document.ErrorName() + ")";
  }
}

}  // namespace

const std::string* Element::attribute(std::string_view name) const {
  for (const auto& a : attributes) {
    if (a.name == name) return &a.value;
  }
  return nullptr;
}

void fail(const Element& at, const std::string& text, Reason reason) {
  throw LoadError(reason, *at.file + ":" + std::to_string(at.line) + ": " + text);
}

Element parse(std::string_view text, const std::string& file) {
  if (text.size() > kMaxBytes) throw LoadError(Reason::out_of_range, file + ": larger than 4 MB");
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw LoadError(Reason::syntax, file + ":" + std::to_string(std::max(1, document.ErrorLineNum())) + ": " +
                                        explain(document));
  }
  const auto* root = document.RootElement();
  if (!root) throw LoadError(Reason::syntax, file + ":1: no element, expected <root BTCPP_format=\"4\">");
  return convert(*root, std::make_shared<const std::string>(file));
}

std::string read_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw LoadError(Reason::cannot_read, path + ": no such file");
  }
  if (std::filesystem::file_size(path, error) > kMaxBytes || error) {
    throw LoadError(Reason::cannot_read, path + ": cannot be read, or larger than 4 MB");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw LoadError(Reason::cannot_read, path + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace adit::bt::xml

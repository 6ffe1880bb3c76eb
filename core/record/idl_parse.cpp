// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <charconv>
#include <optional>

#include "core/record/idl_value.hpp"

namespace adit::record {
namespace {

using Kind = IdlType::Kind;
using TypeRef = std::shared_ptr<const IdlType>;

struct Wrong {
  std::string text;
};

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto is_word = [&](std::size_t at) {
      return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
    };
    if (text.substr(i, 2) == "//") {
      i = std::min(text.find('\n', i), text.size());
    } else if (is_word(i)) {
      std::size_t end = i;
      while (is_word(end) || (text.substr(end, 2) == "::" && is_word(end + 2))) end += is_word(end) ? 1 : 2;
      out.emplace_back(text.substr(i, end - i));
      i = end;
    } else {
      if (std::isspace(static_cast<unsigned char>(text[i])) == 0) out.emplace_back(1, text[i]);
      ++i;
    }
  }
  return out;
}

TypeRef number(std::uint8_t size, bool is_signed, bool real = false) {
  IdlType type;
  type.kind = Kind::number;
  type.size = size;
  type.is_signed = is_signed;
  type.real = real;
  return std::make_shared<IdlType>(std::move(type));
}

class Parser {
 public:
  explicit Parser(std::string_view text) : words_(words_of(text)) {}

  IdlTypes go() {
    while (at_ < words_.size()) definition();
    if (!scope_.empty()) throw Wrong{"the end, in a module that is not closed"};
    return std::move(types_);
  }

 private:
  void definition() {
    annotations();
    const std::string word = next();
    if (word == "module") {
      scope_.push_back(next());
      expect("{");
    } else if (word == "}" && !scope_.empty()) {
      scope_.pop_back();
      expect(";");
    } else if (word == "struct") {
      structure();
    } else if (word == "enum") {
      enumeration();
    } else if (word == "typedef") {
      const TypeRef base = type();
      const std::string name = next();
      types_[scoped(name)] = dimensions(base);
      expect(";");
    } else {
      throw Wrong{word};
    }
  }

  void structure() {
    const std::string name = scoped(next());
    IdlType out;
    out.kind = Kind::structure;
    expect("{");
    while (annotations(), peek() != "}") {
      const TypeRef base = type();
      do {
        std::string member = next();
        out.members.push_back({std::move(member), dimensions(base)});
      } while (accept(","));
      expect(";");
    }
    expect("}");
    expect(";");
    types_[name] = std::make_shared<IdlType>(std::move(out));
  }

  void enumeration() {
    const std::string name = scoped(next());
    IdlType out;
    out.kind = Kind::enumeration;
    expect("{");
    do out.names.push_back(next());
    while (accept(","));
    expect("}");
    expect(";");
    types_[name] = std::make_shared<IdlType>(std::move(out));
  }

  TypeRef type() {
    const std::string word = next();
    if (word == "unsigned") {
      const std::string size = next();
      if (size == "short") return number(2, false);
      if (size == "long") return accept("long") ? number(8, false) : number(4, false);
      throw Wrong{size};
    }
    if (word == "long") return accept("long") ? number(8, true) : number(4, true);
    static const std::map<std::string, TypeRef> simple{
        {"short", number(2, true)},        {"octet", number(1, false)},   {"char", number(1, false)},
        {"float", number(4, true, true)},  {"int8", number(1, true)},     {"uint8", number(1, false)},
        {"int16", number(2, true)},        {"uint16", number(2, false)},  {"int32", number(4, true)},
        {"uint32", number(4, false)},      {"int64", number(8, true)},    {"uint64", number(8, false)},
        {"double", number(8, true, true)}, {"boolean", of(Kind::boolean)}};
    if (const auto it = simple.find(word); it != simple.end()) return it->second;
    if (word == "string") {
      if (accept("<")) next(), expect(">");
      return of(Kind::text);
    }
    if (word == "sequence") {
      expect("<");
      IdlType out;
      out.kind = Kind::sequence;
      out.element = type();
      if (accept(",")) next();
      expect(">");
      return std::make_shared<IdlType>(std::move(out));
    }
    return named(word);
  }

  /// Looks a name up, from the innermost module outwards.
  TypeRef named(const std::string& name) const {
    for (std::size_t depth = scope_.size() + 1; depth-- > 0;) {
      std::string full;
      for (std::size_t i = 0; i < depth; ++i) full += scope_[i] + "::";
      if (const auto it = types_.find(full + name); it != types_.end()) return it->second;
    }
    throw Wrong{name};
  }

  TypeRef dimensions(const TypeRef& base) {
    std::vector<std::uint32_t> counts;
    while (accept("[")) {
      const std::string word = next();
      std::uint32_t count = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
      if (error != std::errc{} || end != word.data() + word.size()) throw Wrong{word};
      counts.push_back(count);
      expect("]");
    }
    TypeRef out = base;
    for (auto it = counts.rbegin(); it != counts.rend(); ++it) {
      IdlType array;
      array.kind = Kind::array;
      array.count = *it;
      array.element = out;
      out = std::make_shared<IdlType>(std::move(array));
    }
    return out;
  }

  void annotations() {
    while (accept("@")) {
      next();
      if (accept("("))
        while (next() != ")") {
        }
    }
  }
  static TypeRef of(Kind kind) {
    IdlType type;
    type.kind = kind;
    return std::make_shared<IdlType>(std::move(type));
  }
  std::string scoped(const std::string& name) const {
    std::string out;
    for (const std::string& part : scope_) out += part + "::";
    return out + name;
  }
  std::string_view peek() const {
    return at_ < words_.size() ? std::string_view(words_[at_]) : std::string_view();
  }
  std::string next() {
    if (at_ >= words_.size()) throw Wrong{"the end"};
    return words_[at_++];
  }
  bool accept(std::string_view word) {
    if (peek() != word) return false;
    ++at_;
    return true;
  }
  void expect(std::string_view word) {
    const std::string got = next();
    if (got != word) throw Wrong{got + "', expected '" + std::string(word)};
  }

  std::vector<std::string> words_;
  std::size_t at_{};
  std::vector<std::string> scope_{};
  IdlTypes types_{};
};

}  // namespace

Result<IdlTypes> parse_idl(std::string_view text) {
  try {
    return Parser(text).go();
  } catch (const Wrong& wrong) {
    return Error{Reason::syntax, "not understood in the IDL: '" + wrong.text + "'"};
  }
}

}  // namespace adit::record

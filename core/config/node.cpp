// SPDX-License-Identifier: Apache-2.0
#include "core/config/node.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/config/document.hpp"

namespace adit::config {
namespace {

std::string plain(double v) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, v);
  return std::string(buffer, end.ptr);
}

/// Describes a value for a message.
std::string got(const Value& value) {
  switch (value.kind) {
    case Value::Kind::null:
      return "nothing";
    case Value::Kind::list:
      return "a list of " + std::to_string(value.items.size());
    case Value::Kind::mapping:
      return "a mapping";
    case Value::Kind::scalar:
      break;
  }
  const std::string text = value.scalar.substr(0, 64);
  return value.quoted ? "the text \"" + text + "\"" : "'" + text + "'";
}

/// Parses a number that makes up all of the text.
template <class T>
bool parse_complete(const std::string& text, T& out) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  const auto [at, error] = std::from_chars(begin, end, out);
  return error == std::errc{} && at == end && begin != end;
}

bool parse_number(const Value& value, double& out) {
  return value.kind == Value::Kind::scalar && !value.quoted && parse_complete(value.scalar, out) &&
         std::isfinite(out);
}

}  // namespace

std::string Range::text() const {
  const bool low = min > -std::numeric_limits<double>::max(), high = max < std::numeric_limits<double>::max();
  if (low && high) return (min_excluded ? " in (" : " in [") + plain(min) + ", " + plain(max) + "]";
  if (low) return (min_excluded ? " above " : " of at least ") + plain(min);
  if (high) return " of at most " + plain(max);
  return "";
}

const Value* Node::find(std::string_view key, bool required) const {
  if (!value_) return nullptr;
  if (value_->kind != Value::Kind::mapping) {
    usable("a mapping with keys");
    return nullptr;
  }
  if (std::find(value_->asked.begin(), value_->asked.end(), key) == value_->asked.end())
    value_->asked.emplace_back(key);
  for (const auto& entry : value_->entries)
    if (entry.key == key) {
      if (entry.value->kind != Value::Kind::null) return entry.value.get();
      if (required) document_->fail(entry.line, Reason::wrong_type, std::string(key) + ": has no value");
      return nullptr;
    }
  if (required)
    document_->fail(value_->line, Reason::missing_key, "key '" + std::string(key) + "' is missing");
  return nullptr;
}

bool Node::usable(const char* expected) const {
  if (value_) fail(Reason::wrong_type, std::string("expected ") + expected + ", got " + got(*value_));
  return false;
}

void Node::fail(Reason reason, const std::string& text) const {
  if (document_) document_->fail(line(), reason, name_.empty() ? text : name_ + ": " + text);
}

Node Node::child_if(std::string_view key) const {
  Node node(document_, find(key, false));
  node.name_ = key;
  return node;
}

Node Node::child(std::string_view key) const {
  Node node(document_, find(key, true));
  node.name_ = key;
  return node;
}

bool Node::has(std::string_view key) const { return is_mapping() && find(key, false) != nullptr; }
bool Node::has_null(std::string_view key) const {
  if (!is_mapping() || has(key)) return false;
  return std::any_of(value_->entries.begin(), value_->entries.end(),
                     [&](const auto& entry) { return entry.key == key; });
}
bool Node::is_mapping() const { return value_ && value_->kind == Value::Kind::mapping; }
bool Node::is_list() const { return value_ && value_->kind == Value::Kind::list; }
bool Node::is_scalar() const { return value_ && value_->kind == Value::Kind::scalar; }
int Node::line() const { return value_ ? value_->line : 0; }
std::string Node::where() const { return file() + ":" + std::to_string(line()); }
const std::string& Node::file() const {
  static const std::string none;
  return document_ ? document_->file() : none;
}

double Node::as_number(Range range) const {
  const double fallback = range.contains(0) ? 0.0 : range.max;
  double v = 0;
  if (!value_) return fallback;
  const std::string expected = "expected a number" + range.text() + ", got " + got(*value_);
  if (!parse_number(*value_, v)) {
    fail(Reason::wrong_type, expected);
    return fallback;
  }
  if (!range.contains(v)) {
    fail(Reason::out_of_range, expected);
    return fallback;
  }
  return v;
}

std::int64_t Node::as_integer(std::int64_t min, std::int64_t max) const {
  if (!value_) return min;
  std::int64_t v = 0;
  const std::string expected = "expected a whole number in [" + std::to_string(min) + ", " +
                               std::to_string(max) + "], got " + got(*value_);
  if (value_->kind != Value::Kind::scalar || value_->quoted || !parse_complete(value_->scalar, v)) {
    fail(Reason::wrong_type, expected);
    return min;
  }
  if (v < min || v > max) {
    fail(Reason::out_of_range, expected);
    return min;
  }
  return v;
}

bool Node::as_flag() const {
  if (!value_) return false;
  const auto says = [this](const char* word) {
    return is_scalar() && !value_->quoted && value_->scalar == word;
  };
  if (says("true") || says("yes")) return true;
  if (says("false") || says("no")) return false;
  return usable("true or false");
}

std::string Node::as_text() const {
  if (is_scalar()) return value_->scalar;
  usable("a text");
  return {};
}

std::size_t Node::as_choice(const std::vector<std::string>& words) const {
  if (!value_) return 0;
  const auto found = is_scalar() ? std::find(words.begin(), words.end(), value_->scalar) : words.end();
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  std::string text = "expected one of ";
  for (std::size_t i = 0; i < words.size(); ++i) text += (i ? ", " : "") + words[i];
  text += "; got " + got(*value_);
  const std::string meant = is_scalar() ? nearest(value_->scalar, words) : "";
  if (!meant.empty()) text += ", did you mean '" + meant + "'?";
  fail(is_scalar() ? Reason::out_of_range : Reason::wrong_type, text);
  return 0;
}

std::vector<double> Node::as_numbers(std::size_t min_count, std::size_t max_count, Range range) const {
  std::vector<double> out(min_count, range.contains(0) ? 0.0 : range.max);
  if (!value_) return out;
  const std::string count = min_count == max_count
                                ? std::to_string(min_count)
                                : std::to_string(min_count) + " to " + std::to_string(max_count);
  if (!is_list() || value_->items.size() < min_count || value_->items.size() > max_count) {
    usable(("a list of " + count + " numbers").c_str());
    return out;
  }
  std::vector<double> read;
  for (const auto& item : value_->items) {
    Node node(document_, item.get());
    node.name_ = name_;
    read.push_back(node.as_number(range));
  }
  return read;
}

std::vector<Node> Node::as_list() const {
  std::vector<Node> out;
  if (!value_) return out;
  if (!is_list()) {
    usable("a list");
    return out;
  }
  for (const auto& item : value_->items) {
    out.emplace_back(document_, item.get());
    out.back().name_ = name_;
  }
  return out;
}

std::vector<std::pair<std::string, Node>> Node::entries() const {
  std::vector<std::pair<std::string, Node>> out;
  if (!value_) return out;
  if (!is_mapping()) {
    usable("a mapping");
    return out;
  }
  for (const auto& entry : value_->entries) {
    value_->asked.push_back(entry.key);
    Node node(document_, entry.value->kind == Value::Kind::null ? nullptr : entry.value.get());
    node.name_ = entry.key;
    out.emplace_back(entry.key, std::move(node));
  }
  return out;
}

Result<void> Node::finish() const {
  if (!document_) return Error{Reason::missing_key, "nothing was read"};
  return document_->finish();
}

}  // namespace adit::config

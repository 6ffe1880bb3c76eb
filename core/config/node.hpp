// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result/result.hpp"

namespace adit::config {

/// Range of valid numbers in interval notation: (0, 10] excludes 0.
struct Range {
  double min{-std::numeric_limits<double>::max()};
  double max{std::numeric_limits<double>::max()};
  bool min_excluded{false};
  bool contains(double v) const { return (min_excluded ? v > min : v >= min) && v <= max; }
  std::string text() const;  ///< "in (0, 10]", "of at least 0", or "" when any number is valid.
};
inline Range any_number() { return {}; }
inline Range within(double min, double max) { return {min, max, false}; }  ///< [min, max]
inline Range positive_up_to(double max) { return {0, max, true}; }         ///< (0, max]

class Document;
struct Value;

/// A node of a YAML file during reading. Every accessor records errors with file and line and returns the
/// fallback, so that a reader is a list of assignments; finish() on the root then returns the first error, or
/// reports a key that no accessor read. A Node that is missing or has the wrong type returns fallbacks for
/// every access and records nothing more.
class Node {
 public:
  Node() = default;
  Node(std::shared_ptr<Document> document, const Value* value)
      : document_(std::move(document)), value_(value) {}

  // --- Keys of a mapping: without a fallback they are required. ---
  bool has(std::string_view key) const;
  /// Whether the key is present and its value is null (`key: null`, `key: ~`, `key:`), which otherwise counts
  /// as missing.
  bool has_null(std::string_view key) const;
  double number(std::string_view key, Range range = {}) const;
  double number(std::string_view key, Range range, double fallback) const;
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max) const;
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max, std::int64_t fallback) const;
  bool flag(std::string_view key) const;
  bool flag(std::string_view key, bool fallback) const;
  std::string text(std::string_view key) const;
  std::string text(std::string_view key, std::string fallback) const;
  /// Returns the index of the word among `words`.
  std::size_t choice(std::string_view key, const std::vector<std::string>& words) const;
  std::size_t choice(std::string_view key, const std::vector<std::string>& words, std::size_t fallback) const;
  /// Reads a list of `min_count` to `max_count` numbers.
  std::vector<double> numbers(std::string_view key, std::size_t min_count, std::size_t max_count,
                              Range range = {}) const;
  std::vector<double> numbers(std::string_view key, std::size_t min_count, std::size_t max_count, Range range,
                              std::vector<double> fallback) const;
  std::vector<std::string> texts(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key, std::vector<std::string> fallback) const;
  /// Returns the node of a key of any type; `child` requires the key, with `child_if` it may be missing.
  Node child(std::string_view key) const;
  Node child_if(std::string_view key) const;
  /// Returns the elements of a list; `list_if`: none when the key is missing.
  std::vector<Node> list(std::string_view key) const;
  std::vector<Node> list_if(std::string_view key) const;
  /// Returns all entries of a mapping with arbitrary keys, in the order of the file; all of them count as
  /// read.
  std::vector<std::pair<std::string, Node>> entries() const;

  // --- This node itself. ---
  /// False for a missing (or null) node.
  bool present() const { return value_ != nullptr; }
  bool is_mapping() const;
  bool is_list() const;
  bool is_scalar() const;
  double as_number(Range range = {}) const;
  std::int64_t as_integer(std::int64_t min, std::int64_t max) const;
  bool as_flag() const;
  std::string as_text() const;
  std::size_t as_choice(const std::vector<std::string>& words) const;
  std::vector<double> as_numbers(std::size_t min_count, std::size_t max_count, Range range = {}) const;
  std::vector<Node> as_list() const;

  /// Position in the form "file:line".
  std::string where() const;
  const std::string& file() const;
  int line() const;
  /// Records a semantic error at this node: "file:line: text".
  void fail(Reason reason, const std::string& text) const;

  /// Returns Ok, or the first error as one line; call it after everything was read. Unknown keys are reported
  /// in every mapping of which a key was read; for a misspelt one the message contains the most similar key.
  Result<void> finish() const;

 private:
  const Value* find(std::string_view key, bool required) const;
  bool usable(const char* expected) const;
  std::string name_{};  // The key of this node, for messages.
  std::shared_ptr<Document> document_{};
  const Value* value_{nullptr};
};

/// Reads a YAML file of at most 1 MiB, 64 levels and 200 000 values. Errors: cannot_read, syntax.
Result<Node> load(const std::string& path);
/// Parses a text; `file` is the name shown in messages.
Result<Node> parse(const std::string& text, const std::string& file);

}  // namespace adit::config

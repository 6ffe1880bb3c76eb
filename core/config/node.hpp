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

/// What a number may be. Written as in mathematics: (0, 10] leaves 0 out.
struct Range {
  double min{-std::numeric_limits<double>::max()};
  double max{std::numeric_limits<double>::max()};
  bool min_excluded{false};
  bool contains(double v) const { return (min_excluded ? v > min : v >= min) && v <= max; }
  std::string text() const;  ///< "in (0, 10]", "of at least 0", "" when anything will do
};
inline Range any_number() { return {}; }
inline Range within(double min, double max) { return {min, max, false}; }  ///< [min, max]
inline Range above(double min, double max) { return {min, max, true}; }    ///< (min, max]

class Document;
struct Value;

/// One place in a YAML file, while it is read. Every accessor notes what is wrong with file and line, and
/// gives the fallback back, so that a reader is a list of assignments; finish() on the root then tells
/// the first error, or that there is a key which nobody asked for. A Node of something that is missing or of
/// the wrong type answers every question with fallbacks and notes nothing more.
class Node {
 public:
  Node() = default;
  Node(std::shared_ptr<Document> document, const Value* value)
      : document_(std::move(document)), value_(value) {}

  // --- keys of a mapping: without a fallback they must be there ---
  bool has(std::string_view key) const;
  /// The key is there and its value is null (`key: null`, `key: ~`, `key:`), which otherwise counts as
  /// missing.
  bool has_null(std::string_view key) const;
  double number(std::string_view key, Range range = {}) const;
  double number(std::string_view key, Range range, double fallback) const;
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max) const;
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max, std::int64_t fallback) const;
  bool flag(std::string_view key) const;
  bool flag(std::string_view key, bool fallback) const;
  std::string text(std::string_view key) const;
  std::string text(std::string_view key, std::string fallback) const;
  /// The index of the word among `words`.
  std::size_t choice(std::string_view key, const std::vector<std::string>& words) const;
  std::size_t choice(std::string_view key, const std::vector<std::string>& words, std::size_t fallback) const;
  /// A list of `min_count` to `max_count` numbers.
  std::vector<double> numbers(std::string_view key, std::size_t min_count, std::size_t max_count,
                              Range range = {}) const;
  std::vector<double> numbers(std::string_view key, std::size_t min_count, std::size_t max_count, Range range,
                              std::vector<double> fallback) const;
  std::vector<std::string> texts(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key, std::vector<std::string> fallback) const;
  /// Whatever is there; `child` must be there, `child_if` may be missing.
  Node child(std::string_view key) const;
  Node child_if(std::string_view key) const;
  /// The elements of a list; `list_if`: none when the key is missing.
  std::vector<Node> list(std::string_view key) const;
  std::vector<Node> list_if(std::string_view key) const;
  /// All keys of a mapping whose keys are free, in the order written; counts as having asked for each.
  std::vector<std::pair<std::string, Node>> entries() const;

  // --- this node itself ---
  /// False for what is missing (or null).
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

  /// "file:line".
  std::string where() const;
  const std::string& file() const;
  int line() const;
  /// Notes an error of meaning at this node: "file:line: text".
  void fail(Reason reason, const std::string& text) const;

  /// After everything was asked for: Ok, or the first error as one line. Unknown keys are looked for in
  /// every mapping of which a key was asked for; a misspelt one is answered with what was probably meant.
  Result<void> finish() const;

 private:
  const Value* find(std::string_view key, bool required) const;
  bool usable(const char* expected) const;
  std::string name_{};  // the key this node was found under, for messages
  std::shared_ptr<Document> document_{};
  const Value* value_{nullptr};
};

/// Reads a YAML file of at most 1 MiB, 64 levels and 200 000 values. Errors: cannot_read, syntax.
Result<Node> load(const std::string& path);
/// The same from memory; `file` is the name that messages show.
Result<Node> parse(const std::string& text, const std::string& file);

}  // namespace adit::config

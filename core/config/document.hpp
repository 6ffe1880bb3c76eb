// SPDX-License-Identifier: Apache-2.0
#pragma once
// The document tree behind config::Node. Private to core/config.
#include <memory>
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::config {

/// A node of a YAML file: null, a scalar, a list or a mapping.
struct Value {
  enum class Kind { null, scalar, list, mapping };
  struct Entry {
    std::string key;
    int line;
    std::shared_ptr<Value> value;
  };
  Kind kind{Kind::null};
  int line{0};  ///< Line number, from 1.
  bool quoted{false};
  std::string scalar{};
  std::vector<std::shared_ptr<Value>> items{};
  std::vector<Entry> entries{};
  mutable std::vector<std::string> asked{};  ///< Keys that a reader looked for.
  mutable bool checked{false};  ///< Set by finish(); with aliases one value appears more than once.
};

/// A YAML file as a tree of values. Collects the errors that its readers find.
class Document {
 public:
  Document(std::string file, std::shared_ptr<Value> root) : file_(std::move(file)), root_(std::move(root)) {}
  const std::string& file() const { return file_; }
  const Value* root() const { return root_.get(); }
  void fail(int line, Reason reason, const std::string& text);
  Result<void> finish();

 private:
  struct Problem {
    int line;
    Reason reason;
    std::string text;
  };
  void find_unknown(const Value& value);
  std::string file_;
  std::shared_ptr<Value> root_;
  std::vector<Problem> problems_{};
};

/// Returns the word of `words` that `text` is a misspelling of, or "".
std::string nearest(const std::string& text, const std::vector<std::string>& words);

}  // namespace adit::config

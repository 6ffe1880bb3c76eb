// SPDX-License-Identifier: Apache-2.0
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/config/document.hpp"
#include "core/config/node.hpp"

namespace adit::config {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxValues = 200'000;
constexpr std::size_t kMaxKeys = 4096;  // Keys of one mapping.

/// Builds the tree from the parser's events. An alias shares the value that it names, so aliases cannot
/// multiply memory.
class DocumentBuilder final : public YAML::EventHandler {
 public:
  std::shared_ptr<Value> take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    leaf(mark, Value::Kind::null, {}, {}, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw YAML::ParserException(mark, "an alias inside of what it names");
    add(mark, found->second);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    leaf(mark, Value::Kind::scalar, tag, value, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, Value::Kind::list, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, Value::Kind::mapping, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    std::shared_ptr<Value> value;
    YAML::anchor_t anchor;
    bool key_next;
    YAML::Mark mark;
  };

  std::shared_ptr<Value> make(const YAML::Mark& mark, Value::Kind kind) {
    if (++values_ > kMaxValues) throw YAML::ParserException(mark, "more than 200000 values");
    auto value = std::make_shared<Value>();
    value->kind = kind;
    value->line = mark.line + 1;
    return value;
  }

  void leaf(const YAML::Mark& mark, Value::Kind kind, const std::string& tag, const std::string& text,
            YAML::anchor_t anchor) {
    auto value = make(mark, kind);
    value->scalar = text;
    value->quoted = tag == "!";  // This is how yaml-cpp marks a quoted scalar.
    if (kind == Value::Kind::scalar && !value->quoted && (text == "~" || text == "null"))
      value->kind = Value::Kind::null;
    if (anchor != YAML::NullAnchor) anchors_[anchor] = value;
    add(mark, std::move(value));
  }

  void open(const YAML::Mark& mark, Value::Kind kind, YAML::anchor_t anchor) {
    if (stack_.size() >= kMaxDepth) throw YAML::ParserException(mark, "nested deeper than 64 levels");
    stack_.push_back({make(mark, kind), anchor, true, mark});
  }

  void close() {
    const Open done = std::move(stack_.back());
    stack_.pop_back();
    if (done.anchor != YAML::NullAnchor) anchors_[done.anchor] = done.value;
    add(done.mark, done.value);
  }

  void add(const YAML::Mark& mark, std::shared_ptr<Value> value) {
    if (stack_.empty()) {
      root_ = std::move(value);
      return;
    }
    Open& top = stack_.back();
    if (top.value->kind == Value::Kind::list) {
      top.value->items.push_back(std::move(value));
    } else if (top.key_next) {
      if (value->kind != Value::Kind::scalar) throw YAML::ParserException(mark, "a key must be a word");
      if (top.value->entries.size() >= kMaxKeys) throw YAML::ParserException(mark, "more than 4096 keys");
      for (const auto& entry : top.value->entries)
        if (entry.key == value->scalar)
          throw YAML::ParserException(
              mark, "key '" + entry.key + "' is given twice, first in line " + std::to_string(entry.line));
      top.value->entries.push_back({value->scalar, mark.line + 1, nullptr});
      top.key_next = false;
    } else {
      top.value->entries.back().value = std::move(value);
      top.key_next = true;
    }
  }

  std::shared_ptr<Value> root_{};
  std::vector<Open> stack_{};
  std::map<YAML::anchor_t, std::shared_ptr<Value>> anchors_{};
  std::size_t values_{0};
};

}  // namespace

Result<Node> parse(const std::string& text, const std::string& file) {
  if (text.size() > kMaxBytes)
    return Error{Reason::syntax, file + ": larger than 1 MiB, which no configuration is"};
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentBuilder builder;
    if (!parser.HandleNextDocument(builder)) return Error{Reason::syntax, file + ":1: the file is empty"};
    auto root = builder.take_root();
    if (!root) return Error{Reason::syntax, file + ":1: the file is empty"};
    DocumentBuilder second;
    if (parser.HandleNextDocument(second))
      return Error{Reason::syntax, file + ": more than one document ('---')"};
    auto document = std::make_shared<Document>(file, std::move(root));
    const Value* value = document->root();
    return Node(std::move(document), value);
  } catch (const YAML::Exception& e) {
    return Error{Reason::syntax, file + ":" + std::to_string(e.mark.line + 1) + ": " + e.msg};
  } catch (const std::exception& e) {
    return Error{Reason::syntax, file + ": " + e.what()};
  }
}

Result<Node> load(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return Error{Reason::cannot_read, path + ": is a folder"};
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return Error{Reason::cannot_read, path + ": cannot read: " + std::strerror(errno ? errno : ENOENT)};
  std::string text(kMaxBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad()) return Error{Reason::cannot_read, path + ": cannot read: " + std::strerror(errno)};
  return parse(text, path);
}

}  // namespace adit::config

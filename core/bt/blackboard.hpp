// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/bt/value.hpp"
#include "core/result/result.hpp"

namespace adit::bt {

/// The named values that the nodes of one tree share. Each SubTree has its own blackboard, which sees only
/// remapped entries of its parent's, or with `_autoremap` all entries whose names do not start with '_'. A
/// key that starts with '@' is looked up in the outermost blackboard.
class Blackboard {
 public:
  struct Entry {
    BlackboardValue value{};
    PortType type{PortType::any};  ///< Text written to a typed entry is converted, or refused.
  };

  explicit Blackboard(Blackboard* parent = nullptr) : parent_(parent) {}
  Blackboard(const Blackboard&) = delete;
  Blackboard& operator=(const Blackboard&) = delete;

  /// Maps the internal name `inside` to the parent's `outside`.
  void remap(const std::string& inside, const std::string& outside) { outside_.emplace(inside, outside); }
  void set_autoremap(bool on) { autoremap_ = on; }

  /// Returns the entry of the key, or nullptr.
  Entry* find(std::string_view key);
  /// Returns the entry of the key; creates an empty one where it belongs if there is none.
  Entry& declare(std::string_view key, PortType type = PortType::any);
  /// Removes the entry if it is in this blackboard itself.
  void unset(std::string_view key);
  /// Writes an entry; throws NodeError when the entry's type refuses the text.
  void set(std::string_view key, BlackboardValue value);

  /// Reads an entry as T. Errors: missing_key when there is none, wrong_type when it holds another type.
  template <class T>
  Result<T> get(std::string_view key) {
    const Entry* entry = find(key);
    if (!entry) return Error{Reason::missing_key, "no blackboard entry '" + std::string(key) + "'"};
    try {
      return value_as<T>(entry->value);
    } catch (const NodeError& error) {
      return Error{Reason::wrong_type, "blackboard entry '" + std::string(key) + "': " + error.what()};
    }
  }
  /// Writes a value of any type. Error wrong_type as for set().
  template <class T>
  Result<void> put(std::string_view key, T content) {
    try {
      set(key, make_value(std::move(content)));
      return {};
    } catch (const NodeError& error) {
      return Error{Reason::wrong_type, "blackboard entry '" + std::string(key) + "': " + error.what()};
    }
  }

 private:
  Blackboard& outermost();
  Blackboard* parent_;
  bool autoremap_{false};
  std::map<std::string, Entry, std::less<>> entries_{};
  std::map<std::string, std::string, std::less<>> outside_{};
};

}  // namespace adit::bt

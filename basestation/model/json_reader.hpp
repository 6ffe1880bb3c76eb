// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result/reason.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// Reads the keys of one JSON object. The first value that does not fit is remembered, and its key.
class JsonReader {
 public:
  static constexpr std::size_t kMaxElements = 100'000;

  /// `wrong`: receives the key that does not fit; empty before.
  JsonReader(const nlohmann::json& object, std::string& wrong) : object_(object), wrong_(wrong) {
    if (!object.is_object()) refuse("an object");
  }

  bool has(const char* key) const { return object_.is_object() && object_.contains(key); }

  /// Sets `out` to the value of the key; leaves it unchanged where the key is missing.
  template <class T>
  void read(const char* key, T& out) {
    const auto found = object_.is_object() ? object_.find(key) : object_.end();
    if (found != object_.end() && !take(*found, out)) refuse(key);
  }
  /// The elements of an array; `take` returns whether an element fits.
  template <class Take>
  void each(const char* key, const Take& take_element) {
    const auto found = object_.is_object() ? object_.find(key) : object_.end();
    if (found == object_.end()) return;
    if (!found->is_array() || found->size() > kMaxElements) return refuse(key);
    for (const nlohmann::json& element : *found)
      if (!take_element(element)) return refuse(key);
  }
  void refuse(const std::string& key) {
    if (wrong_.empty()) wrong_ = key;
  }
  const std::string& wrong() const { return wrong_; }

  static bool take(const nlohmann::json& value, bool& out) {
    if (!value.is_boolean()) return false;
    out = value.get<bool>();
    return true;
  }
  static bool take(const nlohmann::json& value, std::string& out) {
    if (!value.is_string()) return false;
    out = value.get<std::string>();
    return true;
  }
  static bool take(const nlohmann::json& value, Reason& out) {
    if (!value.is_string()) return false;
    // A reason of a newer version is no reason of ours, but it is not `none` either.
    if (!reason_from_name(value.get_ref<const std::string&>(), out)) out = static_cast<Reason>(0xFFFF);
    return true;
  }
  /// JSON has no NaN: it is written as null.
  template <std::floating_point T>
  static bool take(const nlohmann::json& value, T& out) {
    if (!value.is_number() && !value.is_null()) return false;
    out = value.is_null() ? std::numeric_limits<T>::quiet_NaN() : value.get<T>();
    return true;
  }
  template <std::integral T>
  requires(!std::same_as<T, bool>) static bool take(const nlohmann::json& value, T& out) {
    if (value.is_number_unsigned()) {
      if (!std::in_range<T>(value.get<std::uint64_t>())) return false;
      out = static_cast<T>(value.get<std::uint64_t>());
      return true;
    }
    if (!value.is_number_integer() || !std::in_range<T>(value.get<std::int64_t>())) return false;
    out = static_cast<T>(value.get<std::int64_t>());
    return true;
  }
  /// A value of several keys, which its read_fields() reads (model/json_fields.hpp).
  template <class T>
  requires requires(JsonReader& in, T& out) { read_fields(in, out); }
  static bool take(const nlohmann::json& value, T& out) {
    std::string wrong;
    JsonReader in(value, wrong);
    read_fields(in, out);
    return wrong.empty();
  }
  /// An unset value is written as null, or left out.
  template <class T>
  static bool take(const nlohmann::json& value, std::optional<T>& out) {
    out.reset();
    return value.is_null() || take(value, out.emplace());
  }
  template <class T>
  static bool take(const nlohmann::json& value, std::map<std::string, T>& out) {
    if (!value.is_object()) return false;
    for (const auto& [name, member] : value.items())
      if (!take(member, out[name])) return false;
    return true;
  }
  template <class T>
  static bool take(const nlohmann::json& value, std::vector<T>& out) {
    if (!value.is_array() || value.size() > kMaxElements) return false;
    out.clear();
    for (const nlohmann::json& element : value)
      if (!take(element, out.emplace_back())) return false;
    return true;
  }
  template <class T, std::size_t N>
  static bool take(const nlohmann::json& value, std::array<T, N>& out) {
    if (!value.is_array() || value.size() != N) return false;
    for (std::size_t i = 0; i < N; ++i)
      if (!take(value[i], out[i])) return false;
    return true;
  }
  /// One of the words that `to_string` gives for 0, 1, ...
  template <class Enum, class ToString>
  void read_word(const char* key, Enum& out, Enum last, const ToString& to_string) {
    std::string word;
    read(key, word);
    if (word.empty()) return;
    for (int i = 0; i <= static_cast<int>(last); ++i)
      if (word == to_string(static_cast<Enum>(i))) {
        out = static_cast<Enum>(i);
        return;
      }
    refuse(key);
  }

 private:
  const nlohmann::json& object_;
  std::string& wrong_;
};

/// Reads a value of several keys. Error: malformed, "WHAT 'KEY' does not fit".
template <class T>
Result<T> value_from(const nlohmann::json& object, const char* what) {
  T value;
  std::string wrong;
  JsonReader in(object, wrong);
  read_fields(in, value);
  if (!wrong.empty()) return {Reason::malformed, std::string(what) + " '" + wrong + "' does not fit"};
  return value;
}

}  // namespace adit::station

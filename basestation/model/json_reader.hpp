// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
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
  static constexpr bool kReads = true;
  template <class T>
  using Value = T;

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
  template <class T>
  void field(const char* key, T& out) {
    read(key, out);
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
  /// A value of several keys, which its fields() lists (model/json_fields.hpp).
  template <class T>
  requires requires(JsonReader& in, T& out) { fields(in, out); }
  static bool take(const nlohmann::json& value, T& out) {
    std::string wrong;
    JsonReader in(value, wrong);
    fields(in, out);
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
  template <int N>
  static bool take(const nlohmann::json& value, Eigen::Matrix<double, N, 1>& out) {
    std::array<double, N> numbers{};
    if (!take(value, numbers)) return false;
    out = Eigen::Matrix<double, N, 1>(numbers.data());
    return true;
  }
  /// One of the words that `to_string` gives for 0, 1, ...
  template <class Enum, class ToString>
  void word(const char* key, Enum& out, Enum last, const ToString& to_string) {
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
  /// One of two words.
  void flag(const char* key, bool& out, const char* word_if_not, const char* word_if) {
    word(key, out, true, [&](bool value) { return value ? word_if : word_if_not; });
  }
  /// An amount of which null means unknown, 0.
  void known(const char* key, float& amount) {
    read(key, amount);
    if (std::isnan(amount)) amount = 0.0F;
  }
  /// Values that form one array; all 0 where the key is missing.
  template <class... T>
  void list(const char* key, T&... out) {
    std::array<std::common_type_t<T...>, sizeof...(T)> values{};
    read(key, values);
    std::size_t i = 0;
    ((out = values[i++]), ...);
  }
  /// The keys of an object within this one.
  template <class Each>
  void object(const char* key, const Each& each_key) {
    if (!has(key)) return;
    JsonReader in(object_.at(key), wrong_);
    each_key(in);
  }

 private:
  const nlohmann::json& object_;
  std::string& wrong_;
};

/// Writes the keys of one JSON object. Its calls have the names of JsonReader's, so that one function lists
/// the keys of a value for both.
class JsonWriter {
 public:
  static constexpr bool kReads = false;
  template <class T>
  using Value = const T;

  explicit JsonWriter(nlohmann::json& object) : object_(object) {
    if (object.is_null()) object = nlohmann::json::object();
  }

  template <class T>
  void field(const char* key, const T& value) {
    object_[key] = of(value);
  }
  template <class Enum, class ToString>
  void word(const char* key, Enum value, Enum, const ToString& to_string) {
    object_[key] = to_string(value);
  }
  void flag(const char* key, bool value, const char* word_if_not, const char* word_if) {
    object_[key] = value ? word_if : word_if_not;
  }
  void known(const char* key, float amount) {
    object_[key] = amount > 0.0F ? nlohmann::json(amount) : nlohmann::json();
  }
  template <class... T>
  void list(const char* key, const T&... values) {
    object_[key] = {values...};
  }
  template <class Each>
  void object(const char* key, const Each& each_key) {
    JsonWriter out(object_[key]);
    each_key(out);
  }

  template <class T>
  static nlohmann::json of(const T& value) {
    if constexpr (requires(JsonWriter & out) { fields(out, value); }) {
      nlohmann::json object;
      JsonWriter out(object);
      fields(out, value);
      return object;
    } else {
      return value;
    }
  }
  static nlohmann::json of(const Reason& reason) { return name(reason); }
  template <int N>
  static nlohmann::json of(const Eigen::Matrix<double, N, 1>& vector) {
    return std::vector<double>(vector.begin(), vector.end());
  }
  template <class T>
  static nlohmann::json of(const std::optional<T>& value) {
    return value ? of(*value) : nlohmann::json();
  }
  template <class T>
  static nlohmann::json of(const std::vector<T>& values) {
    nlohmann::json out = nlohmann::json::array();
    for (const T& value : values) out.push_back(of(value));
    return out;
  }
  template <class T>
  static nlohmann::json of(const std::map<std::string, T>& values) {
    nlohmann::json out = nlohmann::json::object();
    for (const auto& [key, value] : values) out[key] = of(value);
    return out;
  }

 private:
  nlohmann::json& object_;
};

/// Reads a value of several keys. Error: malformed, "WHAT 'KEY' does not fit".
template <class T>
Result<T> value_from(const nlohmann::json& object, const char* what) {
  T value;
  std::string wrong;
  JsonReader in(object, wrong);
  fields(in, value);
  if (!wrong.empty()) return {Reason::malformed, std::string(what) + " '" + wrong + "' does not fit"};
  return value;
}

}  // namespace adit::station

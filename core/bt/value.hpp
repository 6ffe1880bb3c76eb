// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <any>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/bt/status.hpp"

namespace adit::bt {

/// A C++ value that scripts and text cannot represent: only leaves write and read it.
struct Opaque {
  std::any content{};
};

/// Value of a blackboard entry; monostate while it is declared but not written.
using BlackboardValue = std::variant<std::monostate, std::int64_t, double, std::string, Opaque>;

/// How the text of a port is parsed. `natural` is a non-negative integer.
enum class PortType : std::uint8_t { any, integer, natural, real, boolean, text, status };
/// Description for error messages: "an integer", "true or false", ...
std::string_view describe(PortType type);
/// Whether the text can be parsed as that type.
bool readable_as(std::string_view text, PortType type);

inline bool is_empty(const BlackboardValue& v) { return std::holds_alternative<std::monostate>(v); }
inline bool is_text(const BlackboardValue& v) { return std::holds_alternative<std::string>(v); }
inline bool is_number(const BlackboardValue& v) {
  return std::holds_alternative<std::int64_t>(v) || std::holds_alternative<double>(v);
}

// The conversions of BehaviorTree.CPP's Any; each throws NodeError when the value does not fit.
std::int64_t to_integer(const BlackboardValue& v);
double to_real(const BlackboardValue& v);
/// Reads a port as bool; accepts also the texts "true", "false", "1", "0".
bool to_boolean(const BlackboardValue& v);
std::string to_text(const BlackboardValue& v);
NodeStatus to_status(const BlackboardValue& v);
/// Truth value of a script's result: only numbers; an integer must be 0 or 1.
bool to_condition(const BlackboardValue& v);
/// Assigns to an existing value and preserves the destination's kind (an integer stays an integer).
void copy_into(const BlackboardValue& from, BlackboardValue& to);
/// Splits a text such as "1;2;3".
std::vector<std::string> split(std::string_view text, char separator);

/// Converts the value of a port or entry to T (bool, integers, floating point, std::string, NodeStatus,
/// std::vector<double>, or the exact type that a leaf wrote). Throws NodeError.
template <class T>
T value_as(const BlackboardValue& v) {
  if constexpr (std::is_same_v<T, BlackboardValue>) {
    return v;
  } else if constexpr (std::is_same_v<T, bool>) {
    return to_boolean(v);
  } else if constexpr (std::is_integral_v<T>) {
    const std::int64_t wide = to_integer(v);
    if (!std::in_range<T>(wide)) throw NodeError("number " + std::to_string(wide) + " is out of range");
    return static_cast<T>(wide);
  } else if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(to_real(v));
  } else if constexpr (std::is_same_v<T, std::string>) {
    return to_text(v);
  } else if constexpr (std::is_same_v<T, NodeStatus>) {
    return to_status(v);
  } else {
    if (const auto* opaque = std::get_if<Opaque>(&v)) {
      if (const auto* content = std::any_cast<T>(&opaque->content)) return *content;
    }
    if constexpr (std::is_same_v<T, std::vector<double>>) {
      std::vector<double> out;
      for (const auto& part : split(to_text(v), ';')) out.push_back(to_real(BlackboardValue(part)));
      return out;
    }
    throw NodeError("the value has another type");
  }
}

/// Wraps `content` as a BlackboardValue.
template <class T>
BlackboardValue make_value(T content) {
  if constexpr (std::is_same_v<T, BlackboardValue>) {
    return content;
  } else if constexpr (std::is_integral_v<T>) {
    return BlackboardValue(static_cast<std::int64_t>(content));
  } else if constexpr (std::is_floating_point_v<T>) {
    return BlackboardValue(static_cast<double>(content));
  } else if constexpr (std::is_convertible_v<T, std::string>) {
    return BlackboardValue(std::string(std::move(content)));
  } else if constexpr (std::is_same_v<T, NodeStatus>) {
    return BlackboardValue(std::string(name(content)));
  } else {
    return BlackboardValue(Opaque{std::any(std::move(content))});
  }
}

}  // namespace adit::bt

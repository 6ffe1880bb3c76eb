// SPDX-License-Identifier: Apache-2.0
#include "core/bt/value.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace adit::bt {

namespace {

template <class T>
bool read_number(std::string_view text, T& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

bool read_boolean(std::string_view text, bool& out) {
  out = text == "1" || text == "true" || text == "TRUE" || text == "True";
  return out || text == "0" || text == "false" || text == "FALSE" || text == "False";
}

std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

}  // namespace

std::string_view describe(PortType type) {
  switch (type) {
    case PortType::any:
      return "anything";
    case PortType::integer:
      return "an integer";
    case PortType::natural:
      return "an integer of at least 0";
    case PortType::real:
      return "a number";
    case PortType::boolean:
      return "true or false";
    case PortType::text:
      return "a text";
    case PortType::status:
      return "SUCCESS, FAILURE, RUNNING or SKIPPED";
  }
  return "anything";
}

bool readable_as(std::string_view text, PortType type) {
  std::int64_t integer = 0;
  double real = 0;
  bool boolean = false;
  constexpr auto kInt = std::numeric_limits<std::int32_t>::max();
  switch (type) {
    case PortType::any:
    case PortType::text:
      return true;
    case PortType::integer:
      return read_number(text, integer) && std::abs(integer) <= kInt;
    case PortType::natural:
      return read_number(text, integer) && integer >= 0 && integer <= 2LL * kInt + 1;
    case PortType::real:
      return read_number(text, real);
    case PortType::boolean:
      return read_boolean(text, boolean);
    case PortType::status:
      return status_from_name(text).has_value();
  }
  return true;
}

std::int64_t to_integer(const BlackboardValue& v) {
  if (const auto* integer = std::get_if<std::int64_t>(&v)) return *integer;
  if (const auto* real = std::get_if<double>(&v)) {
    // As in BehaviorTree.CPP, a fraction is an error and is not silently truncated.
    if (std::abs(*real) > 9.0e18 || *real != std::nearbyint(*real)) {
      throw NodeError("number " + std::to_string(*real) + " is not an integer");
    }
    return static_cast<std::int64_t>(*real);
  }
  if (const auto* text = std::get_if<std::string>(&v)) {
    std::int64_t out = 0;
    if (!read_number(*text, out)) throw NodeError(in_quotes(*text) + " is not an integer");
    return out;
  }
  throw NodeError(is_empty(v) ? "the entry was never written" : "the value is not a number");
}

double to_real(const BlackboardValue& v) {
  if (const auto* integer = std::get_if<std::int64_t>(&v)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&v)) return *real;
  if (const auto* text = std::get_if<std::string>(&v)) {
    double out = 0;
    if (!read_number(*text, out)) throw NodeError(in_quotes(*text) + " is not a number");
    return out;
  }
  throw NodeError(is_empty(v) ? "the entry was never written" : "the value is not a number");
}

bool to_boolean(const BlackboardValue& v) {
  if (const auto* text = std::get_if<std::string>(&v)) {
    bool out = false;
    if (!read_boolean(*text, out)) throw NodeError(in_quotes(*text) + " is neither true nor false");
    return out;
  }
  return to_condition(v);
}

bool to_condition(const BlackboardValue& v) {
  if (const auto* integer = std::get_if<std::int64_t>(&v)) {
    if (*integer != 0 && *integer != 1) {
      throw NodeError("number " + std::to_string(*integer) + " is neither true (1) nor false (0)");
    }
    return *integer == 1;
  }
  if (const auto* real = std::get_if<double>(&v)) return *real != 0.0;
  throw NodeError(is_empty(v) ? "the entry was never written" : "the value is neither true nor false");
}

std::string to_text(const BlackboardValue& v) {
  if (const auto* text = std::get_if<std::string>(&v)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&v)) return std::to_string(*integer);
  if (const auto* real = std::get_if<double>(&v)) return std::to_string(*real);
  throw NodeError(is_empty(v) ? "the entry was never written" : "the value is not a text");
}

NodeStatus to_status(const BlackboardValue& v) {
  const std::string text = to_text(v);
  if (const auto status = status_from_name(text)) return *status;
  throw NodeError(in_quotes(text) + " is not a status");
}

void copy_into(const BlackboardValue& from, BlackboardValue& to) {
  if (is_empty(to) || from.index() == to.index()) {
    to = from;
  } else if (is_number(from) && std::holds_alternative<std::int64_t>(to)) {
    to = to_integer(from);
  } else if (is_number(from) && std::holds_alternative<double>(to)) {
    to = to_real(from);
  } else {
    throw NodeError("the entry holds a value of another type");
  }
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const auto end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return parts;
}

}  // namespace adit::bt

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/bt/value.hpp"

namespace adit::bt {

enum class Direction : std::uint8_t { input, output, inout };

/// A port of a kind of node: an XML attribute that holds a value or, as "{key}", names a blackboard entry
/// ("{=}": the entry with the port's name).
struct Port {
  std::string name{};
  Direction direction{Direction::input};
  PortType type{PortType::any};
  bool required{false};                   ///< The XML must give it.
  std::optional<std::string> fallback{};  ///< Default text when the XML does not give it.
};
using Ports = std::vector<Port>;

/// Creates a port of a manifest, by direction. The XML may omit an input, which is then missing or has the
/// value `fallback`; it must give a required one.
inline Port input(std::string name, PortType type = PortType::any) {
  return {std::move(name), Direction::input, type, false, std::nullopt};
}
inline Port input(std::string name, PortType type, std::string fallback) {
  return {std::move(name), Direction::input, type, false, std::move(fallback)};
}
inline Port required_input(std::string name, PortType type = PortType::any) {
  return {std::move(name), Direction::input, type, true, std::nullopt};
}
inline Port output(std::string name, PortType type = PortType::any) {
  return {std::move(name), Direction::output, type, false, std::nullopt};
}
inline Port inout(std::string name, PortType type = PortType::any) {
  return {std::move(name), Direction::inout, type, false, std::nullopt};
}

/// Returns the key in "{key}" (spaces around the braces are ignored), or `port` for "{=}" or "=". Returns
/// nothing when the text is a value.
std::optional<std::string> blackboard_key(std::string_view port, std::string_view text);

}  // namespace adit::bt

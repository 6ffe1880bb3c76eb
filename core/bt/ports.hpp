#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/bt/value.hpp"

namespace adit::bt {

enum class Direction : std::uint8_t { input, output, inout };

/// A port that a kind of node has: an XML attribute that holds a value or, as "{key}", names a blackboard
/// entry ("{=}": the entry named as the port).
struct Port {
  std::string name{};
  Direction direction{Direction::input};
  PortType type{PortType::any};
  bool required{false};                   ///< the XML must give it
  std::optional<std::string> fallback{};  ///< its text when the XML does not give it
};
using Ports = std::vector<Port>;

/// One port of a manifest, by direction. An input may be left out in the XML, or then be its `fallback`; a
/// required one may not.
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

/// The key in "{key}" (spaces around the braces are ignored), `port` itself for "{=}" or "=", else nothing:
/// the text is a value.
std::optional<std::string> blackboard_key(std::string_view port, std::string_view text);

}  // namespace adit::bt

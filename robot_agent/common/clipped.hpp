// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>

namespace adit::agent {

/// The text, cut to `max` bytes (3 or more) with "..." at the end if it is longer, so that a long text from
/// another participant does not make a message too large for its topic.
inline std::string clipped(const std::string& text, std::size_t max) {
  return text.size() <= max ? text : text.substr(0, max - 3) + "...";
}

}  // namespace adit::agent

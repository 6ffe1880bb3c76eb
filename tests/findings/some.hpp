// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/findings/finding.hpp"

namespace adit::findings {

inline Finding some(std::uint64_t id, std::uint8_t importance = 1, const std::string& robot = "r1") {
  Finding f;
  f.key = {robot, id};
  f.kind = "artifact";
  f.importance = importance;
  f.position = {1.5, -2.0, 0.25};
  f.stamp = 123456789;
  f.text = "a red backpack";
  f.data = {1, 2, 3};
  return f;
}

}  // namespace adit::findings

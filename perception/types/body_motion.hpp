// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/geometry/pose.hpp"

namespace adit::perception {

/// A pose by wheels, tracks or legs in a frame of their own; only its changes count.
struct BodyMotion {
  std::uint64_t stamp{};  ///< Driver's clock, ns.
  Pose3 pose{};           ///< Of base_link.
};

}  // namespace adit::perception

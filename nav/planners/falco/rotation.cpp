// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

RotationTable::RotationTable(const Footprint& body) {
  constexpr int kAngles = CorrespondenceGrid::kAngles;
  rings_ = static_cast<int>(std::ceil(body.radius() / CorrespondenceGrid::kRing));
  left_.assign(static_cast<std::size_t>(rings_) * kAngles, kAngles);
  right_ = left_;
  for (int ring = 0; ring < rings_; ++ring) {
    const double r = (ring + 0.5) * CorrespondenceGrid::kRing;
    std::array<float, kAngles> depth{};
    for (int a = 0; a < kAngles; ++a) {
      const double angle = (a + 0.5) * M_PI / 180.0;
      depth[a] = body.depth(static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)));
    }
    // While the body turns left by t, the obstacle moves from angle a to a - t in the body's frame. As on
    // paths, an obstacle that is already inside the margin may not get deeper.
    const auto room = [&depth](int a, int side) {
      for (int turn = 0; turn < kAngles; ++turn)
        if (depth[(a - side * turn + kAngles) % kAngles] > std::max(0.0f, depth[a]) + 0.002f)
          return static_cast<std::uint16_t>(std::max(0, turn - 1));
      return static_cast<std::uint16_t>(kAngles);
    };
    for (int a = 0; a < kAngles; ++a) {
      left_[ring * kAngles + a] = room(a, 1);
      right_[ring * kAngles + a] = room(a, -1);
    }
  }
}

void RotationTable::limit(int ring, int angle, TurnRoom& room) const {
  constexpr int kAngles = CorrespondenceGrid::kAngles;
  room.left = std::min<int>(room.left, left_[ring * kAngles + angle]);
  room.right = std::min<int>(room.right, right_[ring * kAngles + angle]);
}

}  // namespace adit::nav

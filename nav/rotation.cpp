#include "nav/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

RotationTable::RotationTable(const SweptBody& body) {
  constexpr int kAngles = CorrespondenceGrid::kAngles;
  const double radius = std::hypot(body.half_length, body.half_width);
  rings_ = static_cast<int>(std::ceil(radius / CorrespondenceGrid::kRing));
  left_.assign(static_cast<std::size_t>(rings_) * kAngles, kAngles);
  for (int ring = 0; ring < rings_; ++ring) {
    const double r = (ring + 0.5) * CorrespondenceGrid::kRing;
    std::array<double, kAngles> depth{};
    for (int a = 0; a < kAngles; ++a) {
      const double angle = (a + 0.5) * M_PI / 180.0;
      depth[a] = std::min(body.half_length - std::fabs(r * std::cos(angle)),
                          body.half_width - std::fabs(r * std::sin(angle)));
    }
    // While the body turns left by t, the obstacle comes from angle a to a - t in the body's frame. As on
    // paths, what is inside the margin already may not come deeper.
    for (int a = 0; a < kAngles; ++a)
      for (int turn = 0; turn < kAngles; ++turn)
        if (depth[(a - turn + kAngles) % kAngles] > std::max(0.0, depth[a]) + 0.002) {
          left_[ring * kAngles + a] = static_cast<std::uint16_t>(std::max(0, turn - 1));
          break;
        }
  }
}

void RotationTable::limit(int ring, int angle, TurnRoom& room) const {
  constexpr int kAngles = CorrespondenceGrid::kAngles;
  // The body is symmetric about its x axis: turning right with an obstacle at a is turning left at -a.
  room.left = std::min<int>(room.left, left_[ring * kAngles + angle]);
  room.right = std::min<int>(room.right, left_[ring * kAngles + (kAngles - 1 - angle)]);
}

}  // namespace adit::nav

// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/near_ground.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

// m: lower things may be the steps of stairs or of a ramp, whose heights TileBuilder compares.
constexpr float kTall = 0.36f;

}  // namespace

NearGround::NearGround(bool climbs)
    : climbs_(climbs), cells_(std::size_t{kSide} * kSide), sums_(std::size_t{kSide} * kSide) {}

void NearGround::take(const LocalMap& map, const Pose3& located) {
  std::ranges::fill(sums_, Sums{});
  const Pose3& body = map.scan().body;
  const Eigen::Vector3f from = body.position.cast<float>(), to = located.position.cast<float>();
  const Eigen::Matrix3f turn =
      (located.orientation * body.orientation.inverse()).toRotationMatrix().cast<float>();
  x0_ = route_cell(located.position.x()) - kHalf;
  y0_ = route_cell(located.position.y()) - kHalf;
  side_ = kSide;
  map.visit(kReach, [&](int ix, int iy, const LocalCell& cell) {
    if (std::isnan(cell.low)) return;  // As around a robot that flies.
    const bool stands = cell.kind == CellClass::obstacle;
    const Eigen::Vector3f at(LocalMap::centre(ix) + (stands ? cell.aside_x * LocalCell::kAsideUnit : 0.0f),
                             LocalMap::centre(iy) + (stands ? cell.aside_y * LocalCell::kAsideUnit : 0.0f),
                             cell.low);
    const Eigen::Vector3f place = to + turn * (at - from);
    const auto u = static_cast<unsigned>(route_cell(double{place.x()}) - x0_),
               v = static_cast<unsigned>(route_cell(double{place.y()}) - y0_);
    if (u >= kSide || v >= kSide) return;
    Sums& sums = sums_[v * kSide + u];
    if (cell.peer || cell.kind == CellClass::mover) {
      sums.passing = true;
    } else if ((stands && cell.high - cell.low <= kTall) || cell.kind == CellClass::drop) {
      sums.undecided = true;
    } else if (stands) {
      sums.x += place.x();
      sums.y += place.y();
      sums.height = std::max(sums.height, cell.high - cell.low);
      ++sums.blocked_count;
    }
    sums.fresh = sums.fresh || cell.fresh;
    (cell.measured ? sums.measured : sums.inherited) += place.z();
    ++(cell.measured ? sums.measured_count : sums.inherited_count);
  });
  std::ranges::transform(sums_, cells_.begin(), cell_of);
  if (climbs_) forget_far_heights();
}

// Behind the face of an obstacle the returns of one direction rise as a ramp does. Elsewhere the height of
// the ground around says nothing about the next tread of stairs.
void NearGround::forget_far_heights() {
  const auto is_blocked = [this](unsigned u, unsigned v) {
    return u < kSide && v < kSide && cells_[v * kSide + u].what == Cell::What::blocked;
  };
  for (unsigned v = 0; v < kSide; ++v)
    for (unsigned u = 0; u < kSide; ++u) {
      Cell& cell = cells_[v * kSide + u];
      if (cell.what != Cell::What::unknown || std::isnan(cell.low)) continue;
      bool beside = false;
      for (const unsigned dv : {~0u, 0u, 1u})
        for (const unsigned du : {~0u, 0u, 1u}) beside = beside || is_blocked(u + du, v + dv);
      if (!beside) cell.low = LocalCell::kNone;
    }
}

NearGround::Cell NearGround::cell_of(const Sums& sums) {
  Cell cell;
  if (sums.measured_count > 0)
    cell.low = sums.measured / sums.measured_count;
  else if (sums.inherited_count > 0)
    cell.low = sums.inherited / sums.inherited_count;
  cell.measured = sums.measured_count > 0;
  cell.fresh = sums.fresh && sums.measured_count > 0;
  if (sums.undecided && sums.blocked_count == 0) return {};
  if (sums.passing) {
    cell.what = Cell::What::passing;
  } else if (sums.blocked_count > 0) {
    cell.what = Cell::What::blocked;
    cell.x = sums.x / sums.blocked_count;
    cell.y = sums.y / sums.blocked_count;
    cell.height = sums.height;
  } else if (sums.measured_count > 0) {
    cell.what = Cell::What::ground;
  }
  return cell;
}

void NearGround::write(SurfaceMap& map) const {
  for (unsigned v = 0; v < side_; ++v)
    for (unsigned u = 0; u < side_; ++u) {
      const Cell& cell = cells_[v * kSide + u];
      const int ix = x0_ + static_cast<int>(u), iy = y0_ + static_cast<int>(v);
      if (std::isnan(cell.low)) continue;
      if (cell.what == Cell::What::blocked) {
        map.see_obstacle(cell.x, cell.y, cell.low, cell.height);
      } else if (cell.what == Cell::What::ground) {
        // What an earlier scan measured counts once.
        const GroundCell* before = cell.fresh ? nullptr : map.cell(ix, iy, cell.low);
        if (!before || !before->known || (!before->measured && !before->blocked))
          map.see_free(ix, iy, cell.low, 0.0f);
      }
    }
}

}  // namespace adit::nav

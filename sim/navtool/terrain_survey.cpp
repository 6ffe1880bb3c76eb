// SPDX-License-Identifier: Apache-2.0
#include "sim/navtool/terrain_survey.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {

TerrainSurvey::TerrainSurvey(const Platform& platform, double range)
    : map_(platform, std::min(range, kMaxRange)), range_(range) {}

void TerrainSurvey::add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s) {
  map_.add_scan(points, body, stamp_s);
  const auto cell = [](double v) { return static_cast<std::int32_t>(std::floor(v / kCell)); };
  const Eigen::Vector2d at = body.position.head<2>();
  const auto far = static_cast<std::int32_t>(range_ / kCell) + 1;
  for (std::int32_t i = cell(at.x()) - far; i <= cell(at.x()) + far; ++i)
    for (std::int32_t j = cell(at.y()) - far; j <= cell(at.y()) + far; ++j) {
      const Eigen::Vector2d middle((i + 0.5) * kCell, (j + 0.5) * kCell);
      if ((middle - at).norm() <= range_ && cells_.size() < kMaxCells) cells_.try_emplace({i, j});
    }
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector2d place = (body * p.cast<double>()).head<2>();
    if (!((place - at).norm() <= range_)) continue;  // Written so that a NaN fails.
    if (const auto found = cells_.find({cell(place.x()), cell(place.y())}); found != cells_.end())
      found->second.covered = true;
  }
  builder_.make(map_, {.stamp_s = stamp_s, .body = body, .located = body});
  const auto ground = builder_.ground_classes();
  window_.assign(ground.begin(), ground.end());
  for (const auto& entry : map_.obstacles().entries())
    if (nav::CellClass& kind = window_[map_.ground().window(entry.x(), entry.y())];
        entry.again && kind != nav::CellClass::drop)
      kind = nav::CellClass::obstacle;
  for (std::size_t index = 0; index < window_.size(); ++index) {
    ++scan_counts_[static_cast<std::size_t>(window_[index])];
    if (window_[index] == nav::CellClass::unknown) continue;
    const Eigen::Vector2f middle = map_.ground().middle(static_cast<int>(index));
    const auto found = cells_.find({cell(middle.x()), cell(middle.y())});
    if (found != cells_.end() && (middle.cast<double>() - at).norm() <= range_)
      found->second.kind = window_[index];
  }
}

TerrainCounts TerrainSurvey::counts() const {
  TerrainCounts out{};
  for (const auto& [key, cell] : cells_) ++out[static_cast<std::size_t>(cell.kind)];
  return out;
}

std::size_t TerrainSurvey::hidden() const {
  return static_cast<std::size_t>(std::count_if(cells_.begin(), cells_.end(), [](const auto& entry) {
    return entry.second.kind == nav::CellClass::unknown && !entry.second.covered;
  }));
}

double TerrainSurvey::unknown_share() const {
  const std::size_t without = hidden(), unknown = counts()[0] - without, all = cells_.size() - without;
  return all > 0 ? static_cast<double>(unknown) / static_cast<double>(all) : 0.0;
}

double TerrainSurvey::drop_share(const TerrainCounts& counts) {
  const auto at = [&](nav::CellClass kind) {
    return static_cast<double>(counts[static_cast<std::size_t>(kind)]);
  };
  const double drops = at(nav::CellClass::drop);
  const double all =
      at(nav::CellClass::ground) + at(nav::CellClass::step) + at(nav::CellClass::slope) + drops;
  return all > 0 ? drops / all : 0.0;
}

}  // namespace adit::sim

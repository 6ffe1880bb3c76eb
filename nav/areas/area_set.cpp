// SPDX-License-Identifier: Apache-2.0
#include "nav/areas/area_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "nav/geometry/segment.hpp"

namespace adit::nav {
namespace {

constexpr double kBeyond = 1e-3;       // m beyond a side, where it is examined which ground lies there.
constexpr double kShortest = 1e-6;     // m: shorter pieces of the border are left out.
constexpr double kPointSpacing = 0.1;  // m between points along the border.
constexpr double kInStrip = 1e-3;      // m: a point is nearer to permitted ground than the margin.
constexpr int kKeepIn = -1;            // Part of the border of the keep_in areas.

Eigen::Vector2d left_of(const BorderPiece& piece) {
  const Eigen::Vector2d way = (piece.to - piece.from).normalized();
  return {-way.y(), way.x()};
}

// The parameters in (0, 1) at which a line is crossed by the sides of a polygon.
void add_crossings(const BorderPiece& line, const Area& area, std::vector<double>& at) {
  const Eigen::Vector2d way = line.to - line.from;
  for (std::size_t i = 0; i < area.corners.size(); ++i) {
    const Eigen::Vector2d a = area.corners[i], side = area.corners[(i + 1) % area.corners.size()] - a;
    const double turn = cross_of(way, side);
    if (std::fabs(turn) < 1e-12) {
      // Along the line: its ends separate what lies beside it from what does not.
      for (const Eigen::Vector2d& end : {a, Eigen::Vector2d(a + side)})
        if (const double t = (end - line.from).dot(way) / way.squaredNorm(); t > 0 && t < 1) at.push_back(t);
      continue;
    }
    const double t = cross_of(a - line.from, side) / turn, s = cross_of(a - line.from, way) / turn;
    if (t > 0 && t < 1 && s >= 0 && s <= 1) at.push_back(t);
  }
}

std::vector<BorderPiece> border_of(const std::vector<Area>& areas, double z) {
  std::vector<BorderPiece> border;
  std::vector<double> cuts;
  for (const Area& area : areas) {
    if (area.kind == AreaKind::prefer || !area.at_height(z)) continue;
    for (std::size_t i = 0; i < area.corners.size(); ++i) {
      BorderPiece side{area.corners[i], area.corners[(i + 1) % area.corners.size()], kKeepIn};
      if (area.kind == AreaKind::keep_out) {
        std::swap(side.from, side.to);
        side.part = static_cast<int>(&area - areas.data());
        border.push_back(side);
        continue;
      }
      // Where the ground beyond is in another area of this kind, there is no border.
      const auto joins = [&](const Area& other) {
        return &other != &area && other.kind == AreaKind::keep_in && other.at_height(z);
      };
      cuts.assign({0.0, 1.0});
      for (const Area& other : areas)
        if (joins(other)) add_crossings(side, other, cuts);
      std::sort(cuts.begin(), cuts.end());
      const Eigen::Vector2d way = side.to - side.from, out = -kBeyond * left_of(side);
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        if ((cuts[k + 1] - cuts[k]) * way.norm() < kShortest) continue;
        const Eigen::Vector2d beyond = side.from + (cuts[k] + cuts[k + 1]) / 2 * way + out;
        const bool inside = std::ranges::any_of(
            areas, [&](const Area& other) { return joins(other) && other.contains(beyond); });
        if (!inside) border.push_back({side.from + cuts[k] * way, side.from + cuts[k + 1] * way, kKeepIn});
      }
    }
  }
  return border;
}

// The part of a line within the half planes to the left of the sides of a convex outline, as parameters;
// nothing if no part is.
std::optional<std::pair<double, double>> part_within(const BorderPiece& line,
                                                     std::span<const Eigen::Vector2d> outline) {
  double first = 0.0, last = 1.0;
  const Eigen::Vector2d way = line.to - line.from;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d side = outline[(i + 1) % outline.size()] - outline[i];
    const double at = cross_of(side, line.from - outline[i]), grows = cross_of(side, way);
    if (grows == 0.0) {
      if (at <= 0.0) return std::nullopt;
    } else if (grows > 0.0) {
      first = std::max(first, -at / grows);
    } else {
      last = std::min(last, -at / grows);
    }
    if (first >= last) return std::nullopt;
  }
  return std::pair{first, last};
}

}  // namespace

struct AreaSet::Content {
  std::vector<Area> areas;
  std::vector<double> margins;                      ///< Of each area, m.
  std::vector<double> levels{};                     ///< Heights at which the areas change, ascending, m.
  std::vector<std::vector<BorderPiece>> borders{};  ///< Below, between and above those.
};

AreaSet::AreaSet(std::vector<Area> areas, std::vector<double> margins) {
  if (areas.empty()) return;
  margins.resize(areas.size(), kMargin);
  Content content{std::move(areas), std::move(margins)};
  for (const Area& area : content.areas)
    for (const double z : {area.z_min - Area::kHeightError, area.z_max + Area::kHeightError})
      if (std::isfinite(z)) content.levels.push_back(z);
  std::sort(content.levels.begin(), content.levels.end());
  for (std::size_t i = 0; i <= content.levels.size(); ++i) {
    const double below = i > 0                    ? content.levels[i - 1]
                         : content.levels.empty() ? 0.0
                                                  : content.levels[0] - 1.0;
    const double above = i < content.levels.size() ? content.levels[i] : below + 1.0;
    content.borders.push_back(border_of(content.areas, (below + above) / 2));
  }
  content_ = std::make_shared<const Content>(std::move(content));
}

std::span<const Area> AreaSet::all() const {
  return content_ ? std::span<const Area>(content_->areas) : std::span<const Area>();
}

const Area* AreaSet::find(std::string_view name) const {
  const auto areas = all();
  const auto found = std::ranges::find(areas, name, &Area::name);
  return found == areas.end() ? nullptr : &*found;
}

bool AreaSet::operator==(const AreaSet& other) const {
  return same(other) || (content_ && other.content_ && content_->areas == other.content_->areas &&
                         content_->margins == other.content_->margins);
}

Result<void> AreaSet::add(Area area) {
  std::vector<Area> areas(all().begin(), all().end());
  const auto old = std::ranges::find(areas, area.name, &Area::name);
  if (old != areas.end())
    *old = std::move(area);
  else if (areas.size() < kMax)
    areas.push_back(std::move(area));
  else
    return {Reason::bad_argument, "there are 16 areas already; remove one first"};
  *this = AreaSet(std::move(areas));
  return {};
}

bool AreaSet::remove(std::string_view name) {
  if (!find(name)) return false;
  *this = only([name](const Area& area) { return area.name != name; });
  return true;
}

AreaSet AreaSet::in_frame(const Pose2& T_other_this, double z) const {
  std::vector<Area> areas(all().begin(), all().end());
  for (Area& area : areas) {
    for (Eigen::Vector2d& corner : area.corners) corner = T_other_this * corner;
    area.z_min -= z;
    area.z_max -= z;
  }
  return AreaSet(std::move(areas));
}

AreaSet AreaSet::with(std::vector<double> margins) const {
  if (empty() || margins == content_->margins) return *this;
  AreaSet changed;
  auto content = std::make_shared<Content>(*content_);
  content->margins = std::move(margins);
  changed.content_ = std::move(content);
  return changed;
}

AreaSet AreaSet::with_margin(double margin) const {
  return with_margins([margin](const Area&) { return margin; });
}

template <class Permits>
bool AreaSet::all_parts(const Eigen::Vector3d& place, Permits&& permits) const {
  if (empty()) return true;
  const std::vector<Area>& areas = content_->areas;
  std::optional<double> keep_in_margin;
  bool within = false;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (areas[i].kind == AreaKind::prefer) continue;
    const bool here = areas[i].at_height(place.z()) && areas[i].contains(place.head<2>());
    if (areas[i].kind == AreaKind::keep_in) {
      keep_in_margin = content_->margins[i];
      within = within || here;
    } else if (!permits(static_cast<int>(i), !here, content_->margins[i])) {
      return false;
    }
  }
  return !keep_in_margin || permits(kKeepIn, within, *keep_in_margin);
}

double AreaSet::to_border(const Eigen::Vector3d& place, int part) const {
  double square = std::numeric_limits<double>::infinity();
  for (const BorderPiece& piece : border(place.z()))
    if (piece.part == part)
      square = std::min(square, squared_distance(place.head<2>(), piece.from, piece.to));
  return std::sqrt(square);
}

bool AreaSet::permits(const Eigen::Vector3d& place) const {
  return all_parts(place, [&](int part, bool on_permitted, double margin) {
    return on_permitted || (margin < 0.0 && to_border(place, part) <= -margin);
  });
}

bool AreaSet::permits(const Eigen::Vector3d& place, double distance) const {
  return all_parts(place, [&](int part, bool on_permitted, double margin) {
    const double reach = margin + distance;
    if (on_permitted) return reach <= 0.0 || to_border(place, part) >= reach;
    return reach < 0.0 && to_border(place, part) <= -reach;
  });
}

double AreaSet::clearance(const Eigen::Vector3d& place) const {
  double least = std::numeric_limits<double>::infinity();
  all_parts(place, [&](int part, bool on_permitted, double) {
    const double distance = to_border(place, part);
    least = std::min(least, on_permitted ? distance : -distance);
    return true;
  });
  return least;
}

double AreaSet::clearance(std::span<const Eigen::Vector2d> outline, double z) const {
  double least = std::numeric_limits<double>::infinity();
  if (empty()) return least;
  for (const Eigen::Vector2d& corner : outline)
    least = std::min(least, clearance(Eigen::Vector3d(corner.x(), corner.y(), z)));
  // A corner of the border may be nearer to a side of the outline, or within it.
  for (const BorderPiece& piece : border(z)) {
    double square = std::numeric_limits<double>::infinity();
    bool within = true;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
      square = std::min(square, squared_distance(piece.from, a, b));
      within = within && cross_of(b - a, piece.from - a) > 0.0;
    }
    least = std::min(least, within ? -std::sqrt(square) : std::sqrt(square));
    // A side that crosses the outline beside all corners.
    if (!within && least > 0.0 && part_within(piece, outline)) least = 0.0;
  }
  return least;
}

bool AreaSet::permits(std::span<const Eigen::Vector2d> outline, double z) const {
  if (empty()) return true;
  for (const Eigen::Vector2d& corner : outline)
    if (!permits(Eigen::Vector3d(corner.x(), corner.y(), z))) return false;
  return std::ranges::none_of(
      border(z), [&](const BorderPiece& piece) { return part_within(piece, outline).has_value(); });
}

bool AreaSet::leaves_room(const Area& area) const {
  constexpr int kSteps = 64;  // Along each side of the rectangle around it.
  Eigen::Vector2d low = area.corners[0], high = low;
  for (const Eigen::Vector2d& corner : area.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const double z = std::isfinite(area.z_min) ? area.z_min : std::isfinite(area.z_max) ? area.z_max : 0.0;
  for (int i = 0; i < kSteps; ++i)
    for (int k = 0; k < kSteps; ++k) {
      const Eigen::Vector2d at =
          low + (high - low).cwiseProduct(Eigen::Vector2d((i + 0.5) / kSteps, (k + 0.5) / kSteps));
      if (area.contains(at) && permits(Eigen::Vector3d(at.x(), at.y(), z))) return true;
    }
  return false;
}

double AreaSet::weight(const Eigen::Vector3d& place) const {
  if (!permits(place)) return 0.0;
  double weight = 1.0;
  for (const Area& area : all())
    if (area.kind == AreaKind::prefer && area.at_height(place.z()) && area.contains(place.head<2>()))
      weight *= area.weight;
  return weight;
}

double AreaSet::margin(std::size_t index) const { return content_->margins[index]; }

double AreaSet::margin(const BorderPiece& piece) const {
  for (std::size_t i = 0; i < content_->areas.size(); ++i)
    if (piece.part == kKeepIn ? content_->areas[i].kind == AreaKind::keep_in
                              : piece.part == static_cast<int>(i))
      return content_->margins[i];
  return kMargin;
}

std::span<const BorderPiece> AreaSet::border(double z) const {
  if (!content_) return {};
  const auto& levels = content_->levels;
  const auto above = std::upper_bound(levels.begin(), levels.end(), z);
  return content_->borders[above - levels.begin()];
}

std::vector<Eigen::Vector2d> outline(const Platform& platform, const Pose2& pose, double margin) {
  std::vector<Eigen::Vector2d> corners = platform.footprint;
  const double x = platform.length / 2, y = platform.width / 2;
  if (corners.size() < 3) corners = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
  for (Eigen::Vector2d& corner : corners)
    corner = pose * Eigen::Vector2d(corner.x() + std::copysign(margin, corner.x()),
                                    corner.y() + std::copysign(margin, corner.y()));
  return corners;
}

void sample_border(const AreaSet& areas, const Eigen::Vector3d& place, double range,
                   std::vector<Eigen::Vector2f>& points) {
  const Eigen::Vector2d centre = place.head<2>();
  for (const BorderPiece& piece : areas.border(place.z())) {
    const double margin = areas.margin(piece), longer = std::fabs(margin);
    const Eigen::Vector2d way = (piece.to - piece.from).normalized();
    // Longer at both ends, so that nothing is open at a corner.
    const Eigen::Vector2d from = piece.from + margin * left_of(piece) - longer * way;
    const double length = (piece.to - piece.from).norm() + 2 * longer;
    // The part within the circle around the place.
    const double middle = (centre - from).dot(way), off = (centre - from - middle * way).norm();
    if (off >= range) continue;
    const double half = std::sqrt(range * range - off * off);
    const double first = std::max(0.0, middle - half), last = std::min(length, middle + half);
    if (first > last) continue;
    const int steps = static_cast<int>(std::ceil((last - first) / kPointSpacing));
    for (int i = 0; i <= steps; ++i) {
      const double along = std::min(last, first + kPointSpacing * i);
      const Eigen::Vector2d point = from + along * way;
      // Beyond the border, the end of one line lies in the strip of another one, which is open.
      if (margin < 0.0 && areas.permits(Eigen::Vector3d(point.x(), point.y(), place.z()), kInStrip)) continue;
      points.push_back(point.cast<float>());
    }
  }
}

}  // namespace adit::nav

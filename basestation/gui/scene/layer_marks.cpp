// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/layer_marks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

#include "basestation/gui/scene/stairs_marks.hpp"

namespace adit::gui {
namespace {

constexpr std::size_t kMaxStars = 500;  // The most important ones come first.
constexpr std::size_t kMaxRibbons = 200;

Shape star(const Point& at, double radius) {
  constexpr int kTips = 5;
  constexpr double kInner = 0.45;  // Share of the radius.
  Shape out{.closed = true, .line = Token::text, .width = 2.0};
  for (int i = 0; i < 2 * kTips; ++i) {
    const double angle = std::numbers::pi * i / kTips, length = i % 2 == 0 ? radius : kInner * radius;
    out.points.push_back({at.x + length * std::sin(angle), at.y - length * std::cos(angle)});
  }
  return out;
}

/// The flag of an operator's mark; its pole stands on the place.
Shape flag(const Point& at, double radius) {
  return {.points = {at,
                     {at.x, at.y - 2 * radius},
                     {at.x + 1.5 * radius, at.y - 1.5 * radius},
                     {at.x, at.y - radius}},
          .closed = true,
          .line = Token::text,
          .width = 2.0};
}

/// How many floors above the one that is shown something at that height stands, m; 0: on it, or all are
/// shown.
int other_floor(const LayerScene& scene, double z) {
  const auto floor = scene.floors && scene.floor ? scene.floors->floor_at(z) : std::nullopt;
  return floor ? static_cast<int>(*floor) - static_cast<int>(*scene.floor) : 0;
}

void add_finding(const LayerScene& scene, const station::FoundItem& item, MarkList& out) {
  const auto [x, y, z] = item.position;
  if (!drawable(x, y)) return;
  const auto at = scene.project({x, y, std::abs(z) < 1e5 ? z : 0.0});
  if (!at) return;
  const double radius = 2.8 * scene.mm;
  const bool picked = item.number == scene.picked;
  const double opacity = other_floor(scene, z) == 0 ? 1.0 : 0.4;
  Shape shape = item.mark ? flag(*at, radius) : star(*at, radius);
  shape.filled = item.verdict == station::Verdict::confirmed;
  shape.fill = Token::ok;
  shape.opacity = opacity;
  if (picked)
    out.shapes.push_back(
        {.points = circle(*at, radius + 5), .closed = true, .line = Token::text, .width = 3.0});
  out.shapes.push_back(std::move(shape));
  const double above = item.mark ? 2 * radius : radius;
  out.labels.push_back({.at = {at->x, at->y - above - (picked ? 14 : 8)},
                        .text = std::to_string(item.number) + (picked ? " " + item.kind : ""),
                        .opacity = opacity});
  out.targets.push_back({.at = *at, .radius = 6.0 * scene.mm, .finding = item.number});
}

/// Where a robot is on the screen, and its size there, pixels; nothing if it cannot be seen.
struct Seen {
  Point at{};
  double extent{};
};
std::optional<Seen> seen(const LayerScene& scene, const std::string& name) {
  const station::Robot* robot = scene.world->robot(name);
  if (!robot || !robot->located || !drawable(robot->x, robot->y)) return std::nullopt;
  const double z = std::abs(robot->z) < 1e5F ? robot->z : 0.0, extent = extent_of(*robot);
  const auto at = scene.project({robot->x, robot->y, z});
  const auto beside = scene.project({robot->x + extent, robot->y, z});
  if (!at || !beside) return std::nullopt;
  return Seen{*at, std::hypot(beside->x - at->x, beside->y - at->y)};
}

void add_convoy(const LayerScene& scene, const std::vector<std::string>& members, MarkList& out) {
  Shape line{.line = Token::text, .width = 3.0, .opacity = 0.6};
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto member = seen(scene, members[i]);
    if (!member) continue;
    line.points.push_back(member->at);
    const double aside = std::max(member->extent / 2, 8.0) + 2.5 * scene.mm;
    out.labels.push_back({.at = {member->at.x + aside, member->at.y - aside},
                          .text = std::to_string(i + 1) + "/" + std::to_string(members.size())});
  }
  if (line.points.size() > 1) out.shapes.push_back(std::move(line));
}

}  // namespace

MarkList layer_marks(const LayerScene& scene) {
  MarkList out;
  if (!scene.project) return out;
  std::set<std::vector<std::string>> convoys;  // Each member says the same one.
  if (scene.world)
    for (const station::Robot& robot : scene.world->robots)
      if (!robot.convoy.empty() && convoys.insert(robot.convoy).second) add_convoy(scene, robot.convoy, out);
  std::set<std::uint32_t> in_ribbons;  // Numbers of findings.
  std::size_t ribbons = 0;
  if (scene.stairs)
    for (const station::StairsItem& item : scene.stairs->stairs) {
      in_ribbons.insert(item.findings.begin(), item.findings.end());
      if (item.verdict != station::Verdict::rejected && ++ribbons <= kMaxRibbons)
        add_stairs(scene, item, out);
    }
  std::size_t stars = 0;
  if (scene.found)
    for (const station::FoundItem& item : scene.found->findings) {
      if (item.withdrawn || item.verdict == station::Verdict::rejected || in_ribbons.contains(item.number))
        continue;
      if (++stars > kMaxStars) break;
      add_finding(scene, item, out);
    }
  return out;
}

MarkList floor_marks(const LayerScene& scene) {
  MarkList out;
  if (!scene.world || !scene.project || !scene.floors || !scene.floor) return out;
  for (const station::Robot& robot : scene.world->robots) {
    const int above = robot.located ? other_floor(scene, robot.z) : 0;
    const auto place = above == 0 ? std::nullopt : seen(scene, robot.name);
    if (!place) continue;
    const double side = 1.8 * scene.mm, up = above > 0 ? -side : side;
    const Point at{place->at.x - std::max(place->extent / 2, 10.0) - 2.0 * scene.mm, place->at.y};
    out.shapes.push_back({.points = {{at.x, at.y + up}, {at.x - side, at.y - up}, {at.x + side, at.y - up}},
                          .closed = true,
                          .line = Token::text,
                          .width = 1.0,
                          .filled = true,
                          .fill = Token::goal});
    out.labels.push_back(
        {.at = {at.x - 4.0 * scene.mm, at.y},
         .text = scene.floors->floors()[*scene.floor + static_cast<std::size_t>(above)].name});
  }
  return out;
}

void add_flag(MarkList& marks, const Point& at, double mm) {
  marks.shapes.push_back(flag(at, 2.8 * mm));
  marks.shapes.back().line = Token::goal;
}

void append(MarkList& marks, MarkList more) {
  const auto move = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  move(marks.shapes, more.shapes);
  move(marks.labels, more.labels);
  move(marks.targets, more.targets);
}

}  // namespace adit::gui

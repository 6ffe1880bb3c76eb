// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/stairs_marks.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace adit::gui {
namespace {

constexpr double kMinChevron = 6.0;  // Width on the screen below which chevrons would be dots, pixels.
constexpr int kMaxChevrons = 8;

class StairsDrawer {
 public:
  StairsDrawer(const LayerScene& scene, const station::StairsItem& item, MarkList& out)
      : scene_(scene),
        item_(item),
        stairs_(item.stairs),
        length_((item.stairs.steps - 1) * item.stairs.run),
        out_(out) {}

  void draw() {
    const auto corners = seen({{0, -half()}, {length_, -half()}, {length_, half()}, {0, half()}});
    const auto middle = seen({{length_ / 2, 0}});
    if (corners.empty() || middle.empty()) return;
    opacity_ = is_on_shown_floor() ? 1.0 : 0.4;
    const bool confirmed = item_.verdict == station::Verdict::confirmed;
    out_.shapes.push_back({.points = corners,
                           .closed = true,
                           .width = picked() ? 4.0 : 2.0,
                           .dashed = item_.robots.size() < 2 && !confirmed,
                           .filled = true,
                           .fill = confirmed ? Token::ok : Token::text,
                           .opacity = opacity_,
                           .fill_opacity = confirmed ? 0.5 : 0.15});
    if (scene_.from_side)
      draw_steps();
    else if (std::hypot(corners[3].x - corners[0].x, corners[3].y - corners[0].y) >= kMinChevron)
      draw_chevrons();
    const auto highest = std::ranges::min_element(corners, {}, &Point::y);
    out_.labels.push_back({.at = {middle[0].x, highest->y - 9},
                           .text = (picked() ? std::to_string(item_.number) + " stairs, " : "") +
                                   std::to_string(stairs_.steps) + " steps",
                           .opacity = opacity_});
    const double reach = std::hypot(corners[1].x - corners[0].x, corners[1].y - corners[0].y) / 2;
    out_.targets.push_back({.at = middle[0],
                            .radius = std::clamp(reach, 6.0 * scene_.mm, 15.0 * scene_.mm),
                            .finding = item_.number});
  }

 private:
  double half() const { return stairs_.width / 2; }
  bool picked() const { return item_.number == scene_.picked; }

  bool is_on_shown_floor() const {
    if (!scene_.floors || !scene_.floor) return true;
    for (const double z : {stairs_.floor_below(), stairs_.floor_above()}) {
      const auto floor = scene_.floors->floor_at(z);
      if (!floor || *floor == *scene_.floor) return true;
    }
    return false;
  }

  /// Places on the line of climbing, m ahead of the foot and to the left, on the screen; empty if one of them
  /// is behind the camera. `raised`: above the line, m.
  std::vector<Point> seen(std::initializer_list<Point> places, double raised = 0.0) const {
    const double c = std::cos(stairs_.heading), s = std::sin(stairs_.heading);
    std::vector<Point> out;
    for (const auto& [ahead, left] : places) {
      const auto at =
          scene_.project({stairs_.foot.x() + ahead * c - left * s, stairs_.foot.y() + ahead * s + left * c,
                          stairs_.foot.z() + ahead * stairs_.rise / stairs_.run + raised});
      if (!at) return {};
      out.push_back(*at);
    }
    return out;
  }

  void line(std::vector<Point> points, double width) {
    if (!points.empty())
      out_.shapes.push_back({.points = std::move(points), .width = width, .opacity = opacity_});
  }

  void draw_chevrons() {
    const int count = std::clamp(static_cast<int>(length_ / stairs_.width * 2), 1, kMaxChevrons);
    const double apart = length_ / count, depth = std::min(0.5 * apart, 0.35 * stairs_.width);
    for (int i = 0; i < count; ++i) {
      const double at = (i + 0.5) * apart, wing = 0.6 * half();
      line(seen({{at - depth / 2, wing}, {at + depth / 2, 0}, {at - depth / 2, -wing}}), 2.0);
    }
  }

  /// A side of a step, from one line across it to another: m ahead of the foot, and the height, m.
  std::vector<Point> side(double from, double low, double to, double high) const {
    const double from_line = low - from * stairs_.rise / stairs_.run - stairs_.foot.z(),
                 to_line = high - to * stairs_.rise / stairs_.run - stairs_.foot.z();
    std::vector<Point> out = seen({{from, -half()}, {from, half()}}, from_line);
    const std::vector<Point> end = seen({{to, half()}, {to, -half()}}, to_line);
    if (out.empty() || end.empty()) return {};
    out.insert(out.end(), end.begin(), end.end());
    return out;
  }

  /// Treads and risers as areas, those that are farther away first.
  void draw_steps() {
    const double run = stairs_.run, rise = stairs_.rise;
    const auto face = [&](std::vector<Point> points, double shade) {
      if (points.empty()) return;
      out_.shapes.push_back({.points = std::move(points),
                             .closed = true,
                             .width = 1.0,
                             .filled = true,
                             .fill = item_.verdict == station::Verdict::confirmed ? Token::ok : Token::none,
                             .opacity = opacity_,
                             .shade = shade});
    };
    const std::vector<Point> first = side(0.0, 0.0, 0.0, 1.0);
    if (first.empty()) return;
    // Which way round the first riser appears shows whether it is seen from the foot.
    const double turn = (first[1].x - first[0].x) * (first[2].y - first[1].y) -
                        (first[1].y - first[0].y) * (first[2].x - first[1].x);
    for (int k = 0; k < stairs_.steps; ++k) {
      const int i = turn > 0.0 ? stairs_.steps - 1 - k : k;
      const double ahead = i * run, top = stairs_.foot.z() + (i + 0.5) * rise;
      if (turn <= 0.0) face(side(ahead, top - rise, ahead, top), 0.5);
      if (i + 1 < stairs_.steps) face(side(ahead, top, ahead + run, top), 1.0);
      if (turn > 0.0) face(side(ahead, top - rise, ahead, top), 0.6);
    }
  }

  const LayerScene& scene_;
  const station::StairsItem& item_;
  const Staircase& stairs_;
  double length_;  ///< Between the lowest and the highest riser, m.
  double opacity_{1.0};
  MarkList& out_;
};

}  // namespace

void add_stairs(const LayerScene& scene, const station::StairsItem& item, MarkList& out) {
  if (!valid(item.stairs) || !drawable(item.stairs.foot.x(), item.stairs.foot.y())) return;
  if (std::abs(item.stairs.foot.z()) < 1e5) StairsDrawer(scene, item, out).draw();
}

}  // namespace adit::gui

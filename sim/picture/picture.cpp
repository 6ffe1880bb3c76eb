// SPDX-License-Identifier: Apache-2.0
#include "sim/picture/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/sketch/picture_frame.hpp"
#include "sim/picture/ground_plan.hpp"

namespace adit::sim {
namespace {

constexpr Colour kFloorTone{1.0, 1.0, 0.995}, kGlimpsedTone{0.865, 0.875, 0.88},
    kFurnitureTone{0.57, 0.61, 0.66}, kWallTone{0.17, 0.20, 0.25};
constexpr Colour kEventTone{0.13, 0.15, 0.19}, kPersonTone{0.45, 0.40, 0.36},
    kPersonPathTone{0.45, 0.40, 0.36, 0.55};
constexpr double kMargin = 28.0, kRow = 24.0;
constexpr std::size_t kMaxEvents = 40;

Colour tone(GroundPlan::Kind kind) {
  switch (kind) {
    case GroundPlan::floor:
      return kFloorTone;
    case GroundPlan::glimpsed:
      return kGlimpsedTone;
    case GroundPlan::furniture:
      return kFurnitureTone;
    case GroundPlan::wall:
      return kWallTone;
    case GroundPlan::unknown:
      break;
  }
  return kPaper;
}

void draw_plan(Sketch& sketch, const GroundPlan& plan, const VoxelGrid& grid, const PictureFrame& frame) {
  const double r = grid.resolution();
  cairo_save(sketch.cairo());
  cairo_rectangle(sketch.cairo(), kMargin, PictureFrame::kHeader, frame.right() - kMargin,
                  frame.bottom() - PictureFrame::kHeader);
  cairo_clip(sketch.cairo());
  for (int j = 0; j < plan.ny; ++j)
    for (int i = 0; i < plan.nx;) {
      // Runs of the same kind as one rectangle on whole pixels: no seams.
      const GroundPlan::Kind kind = plan.at(i, j);
      const int first = i;
      while (i < plan.nx && plan.at(i, j) == kind) ++i;
      if (kind == GroundPlan::unknown) continue;
      const double x0 = std::round(frame.x(grid.origin().x() + first * r)),
                   x1 = std::round(frame.x(grid.origin().x() + i * r));
      const double y0 = std::round(frame.y(grid.origin().y() + (j + 1) * r)),
                   y1 = std::round(frame.y(grid.origin().y() + j * r));
      sketch.fill(x0, y0, x1 - x0, y1 - y0, tone(kind));
    }
  cairo_restore(sketch.cairo());
}

void trace(Sketch& sketch, const PictureFrame& frame, const std::vector<Pose2>& poses, double thickness,
           Colour colour) {
  cairo_set_source_rgba(sketch.cairo(), colour.r, colour.g, colour.b, colour.a);
  cairo_set_line_width(sketch.cairo(), thickness);
  for (const Pose2& p : poses) cairo_line_to(sketch.cairo(), frame.x(p.x), frame.y(p.y));
  cairo_stroke(sketch.cairo());
}

void draw_label(Sketch& sketch, double x, double y, const std::string& text, Colour colour) {
  const double width = sketch.text_width(14, text, true) + 14;
  sketch.rounded(x - width / 2 - 1.5, y - 12.5, width + 3, 25, 7, {1, 1, 1, 0.95});
  sketch.rounded(x - width / 2, y - 11, width, 22, 6, colour);
  sketch.text(x, y, 14, text, {1, 1, 1}, Align::centre, true);
}

Colour colour_of(const PictureSpec& spec, const std::string& id) {
  for (std::size_t n = 0; n < spec.trails.size(); ++n)
    if (spec.trails[n].id == id) return kPalette[n % kPalette.size()];
  return kInk;
}

void draw_people(Sketch& sketch, const PictureFrame& frame, const PictureSpec& spec) {
  for (const PicturePerson& person : spec.people) {
    if (person.poses.empty()) continue;
    const std::array dash{6.0, 5.0};  // Pixels.
    cairo_set_dash(sketch.cairo(), dash.data(), static_cast<int>(dash.size()), 0.0);
    trace(sketch, frame, person.poses, 2.0, kPersonPathTone);
    cairo_set_dash(sketch.cairo(), nullptr, 0, 0.0);
    const Pose2& end = person.poses.back();
    const double radius = std::max(0.5 * person.size * frame.scale, 4.0);
    sketch.disc(frame.x(end.x), frame.y(end.y), radius + 2.0, {1, 1, 1, 0.9});
    sketch.disc(frame.x(end.x), frame.y(end.y), radius, kPersonTone);
  }
}

/// Returns where labels stand, in pixels.
std::vector<Eigen::Vector2d> draw_run(Sketch& sketch, const PictureFrame& frame, const PictureSpec& spec) {
  std::vector<Eigen::Vector2d> labels;
  const auto label = [&](const Eigen::Vector2d& at, const std::string& text, Colour colour) {
    draw_label(sketch, at.x(), at.y(), text, colour);
    labels.push_back(at);
  };
  const double thick = std::clamp(frame.scale * 0.09, 2.5, 6.0);
  for (const PictureTrail& trail : spec.trails)
    trace(sketch, frame, trail.poses, thick + 3.5, {1, 1, 1, 0.9});
  for (const PictureTrail& trail : spec.trails)
    trace(sketch, frame, trail.poses, thick, colour_of(spec, trail.id));
  for (const PictureGoal& goal : spec.goals) {
    const Colour colour = colour_of(spec, goal.robot);
    const double x = frame.x(goal.position.x()), y = frame.y(goal.position.y()),
                 r = std::clamp(0.25 * frame.scale, 6.0, 12.0);
    sketch.disc(x, y, r + 3.0, {1, 1, 1, 0.85});
    sketch.ring(x, y, r, 2.5, colour);
    sketch.line(x - r * 0.5, y, x + r * 0.5, y, 2.0, colour);
    sketch.line(x, y - r * 0.5, x, y + r * 0.5, 2.0, colour);
  }
  for (const PictureTrail& trail : spec.trails) {
    if (trail.poses.empty()) continue;
    const Colour colour = colour_of(spec, trail.id);
    const Pose2& start = trail.poses.front();
    sketch.disc(frame.x(start.x), frame.y(start.y), thick * 1.7 + 2, {1, 1, 1});
    sketch.disc(frame.x(start.x), frame.y(start.y), thick * 1.7, colour);
    draw_body(sketch, frame, trail.poses.back(), trail.length * frame.scale, trail.width * frame.scale,
              colour);
    label({frame.x(start.x), frame.y(start.y) - 30}, trail.id, colour);
    const Pose2& end = trail.poses.back();
    if ((end.position() - start.position()).norm() > 1.5)
      label({frame.x(end.x), frame.y(end.y) + 0.5 * frame.scale * std::max(trail.length, trail.width) + 20},
            trail.id, colour);
  }
  return labels;
}

void draw_marker(Sketch& sketch, double x, double y, std::size_t number) {
  sketch.disc(x, y, 11.5, {1, 1, 1});
  sketch.disc(x, y, 10, kEventTone);
  sketch.text(x, y, number < 10 ? 13 : 11, std::to_string(number), {1, 1, 1}, Align::centre, true);
}

/// Markers that would fall onto one another or onto a label are moved upwards.
void draw_events(Sketch& sketch, const PictureFrame& frame, const PictureSpec& spec,
                 std::vector<Eigen::Vector2d> taken) {
  for (std::size_t n = 0; n < std::min(spec.events.size(), kMaxEvents); ++n) {
    const Eigen::Vector2d place(frame.x(spec.events[n].position.x()), frame.y(spec.events[n].position.y()));
    Eigen::Vector2d spot = place + Eigen::Vector2d(0, -0.6 * frame.scale - 14);
    const auto free = [&] {
      return std::none_of(taken.begin(), taken.end(),
                          [&](const auto& t) { return (t - spot).norm() < 25.0; });
    };
    for (int tries = 0; tries < 40 && !free(); ++tries) spot.y() -= 24.0;
    taken.push_back(spot);
    sketch.line(place.x(), place.y(), spot.x(), spot.y(), 1.2, {kInk.r, kInk.g, kInk.b, 0.6});
    sketch.disc(place.x(), place.y(), 2.5, kInk);
    draw_marker(sketch, spot.x(), spot.y(), n + 1);
  }
}

/// Rows that the legend takes, and its columns.
struct Legend {
  std::size_t columns, event_rows, rows;
};
Legend plan_legend(const PictureSpec& spec) {
  const std::size_t events = std::min(spec.events.size(), kMaxEvents);
  const std::size_t columns = spec.width >= 1400 ? 3 : spec.width >= 900 ? 2 : 1;
  const std::size_t event_columns = std::max<std::size_t>(1, columns - 1);
  const std::size_t event_rows = (events + event_columns - 1) / event_columns;
  const std::size_t robots = spec.trails.size() + (spec.people.empty() ? 0 : 1);
  return {columns, event_rows, columns == 1 ? robots + event_rows : std::max(robots, event_rows)};
}

void draw_legend(Sketch& sketch, const PictureSpec& spec, const Legend& legend, double top) {
  const double column = (spec.width - 2 * kMargin) / static_cast<double>(legend.columns);
  for (std::size_t n = 0; n < spec.trails.size(); ++n) {
    const double y = top + kRow * (static_cast<double>(n) + 0.5);
    const Colour colour = kPalette[n % kPalette.size()];
    sketch.line(kMargin + 4, y, kMargin + 34, y, 5, colour);
    sketch.text(kMargin + 46, y, 15, spec.trails[n].id, kInk, Align::left, true);
    sketch.text(kMargin + 54 + sketch.text_width(15, spec.trails[n].id, true), y, 15, spec.trails[n].label,
                kInk);
  }
  const std::size_t people_row = spec.trails.size(), robot_rows = people_row + (spec.people.empty() ? 0 : 1);
  if (!spec.people.empty()) {
    const double y = top + kRow * (static_cast<double>(people_row) + 0.5);
    sketch.disc(kMargin + 19, y, 7, kPersonTone);
    sketch.text(kMargin + 46, y, 15,
                spec.people.size() == 1 ? "a person" : fmt::format("{} people", spec.people.size()), kInk);
  }
  const double first = legend.columns == 1 ? top + kRow * static_cast<double>(robot_rows) : top;
  for (std::size_t n = 0; n < std::min(spec.events.size(), kMaxEvents); ++n) {
    const std::size_t c = legend.columns == 1 ? 0 : 1 + n / legend.event_rows;
    const double x = kMargin + column * static_cast<double>(c) + 12,
                 y = first + kRow * (static_cast<double>(n % legend.event_rows) + 0.5);
    draw_marker(sketch, x, y, n + 1);
    std::string text = spec.events[n].text;
    while (text.size() > 4 && sketch.text_width(14, text) > column - 40)
      text = text.substr(0, text.size() - 4) + "...";
    sketch.text(x + 20, y, 14, text, kInk);
  }
}

}  // namespace

Result<void> write_picture(const World& world, const PictureSpec& spec, const std::filesystem::path& file) {
  if (spec.width < 400 || spec.width > 8000)
    return {Reason::bad_argument, "picture: width: expected 400 to 8000 pixels"};
  if (!(spec.headroom > 0.0 && spec.headroom <= 5.0))
    return {Reason::bad_argument, "picture: headroom: expected up to 5 m"};
  const GroundPlan plan = make_ground_plan(world, spec.headroom);
  PictureFrame frame{kMargin, plan.low, plan.high};
  for (const PictureTrail& trail : spec.trails)
    for (const Pose2& p : trail.poses) {
      frame.low = frame.low.cwiseMin(p.position() - Eigen::Vector2d::Constant(1.0));
      frame.high = frame.high.cwiseMax(p.position() + Eigen::Vector2d::Constant(1.0));
    }
  if (!frame.low.allFinite() || !frame.high.allFinite() || (frame.high - frame.low).maxCoeff() > 1e5)
    return {Reason::bad_argument, "picture: a trail leaves the world"};
  frame.scale = (spec.width - 2 * kMargin) / (frame.high.x() - frame.low.x());
  frame.scale = std::min(frame.scale, 6000.0 / (frame.high.y() - frame.low.y()));
  const Legend legend = plan_legend(spec);
  const double below = frame.bottom() + 30.0;
  const int height =
      static_cast<int>(below + kRow * static_cast<double>(legend.rows) + (legend.rows ? 20.0 : 4.0));
  Sketch sketch(spec.width, height);
  sketch.fill(0, 0, spec.width, height, kPaper);
  draw_plan(sketch, plan, world.grid(), frame);
  draw_grid(sketch, frame, frame.high.x() - frame.low.x() > 12.0 ? 5.0 : 1.0);
  draw_people(sketch, frame, spec);
  draw_events(sketch, frame, spec, draw_run(sketch, frame, spec));
  sketch.text(kMargin, 32, 26, spec.title, kInk, Align::left, true);
  sketch.text(kMargin, 62, 15, spec.subtitle, kFaint);
  draw_legend(sketch, spec, legend, below);
  if (!sketch.save(file.string()))
    return {Reason::cannot_write, file.string() + ": the picture cannot be written; does its folder exist?"};
  return {};
}

}  // namespace adit::sim

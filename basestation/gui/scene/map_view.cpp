// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/map_view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "basestation/gui/scene/layer_marks.hpp"
#include "basestation/gui/scene/theme.hpp"

namespace adit::gui {
namespace {

constexpr double kLeastScale = 8.0;  // Pixels per m, so that a robot can be seen.

}  // namespace

MapView::MapView(QQuickItem* parent)
    : GestureArea(parent), map_(new MapItem2D(this)), marks_(new MarkPainter(this)) {
  setClip(true);
  connect(this, &MapView::covered_changed, marks_, [this] { marks_->set_inset(covered_right_); });
}

void MapView::set_control(Control* control) {
  if (control == control_) return;
  if (control_)
    control_->disconnect(this), control_->area()->disconnect(this), control_->mark()->disconnect(this),
        control_->tabs()->disconnect(this), control_->follow()->disconnect(this);
  control_ = control;
  if (control_) {
    connect(control_, &Control::shown, this, &MapView::refresh);
    connect(control_->area(), &AreaTool::changed, this, &MapView::refresh);
    connect(control_->mark(), &MarkTool::changed, this, &MapView::refresh);
    connect(control_->tabs(), &TabState::findings_changed, this, &MapView::refresh);
    connect(control_->tabs(), &TabState::network_changed, this, &MapView::measure_reception);
    connect(control_, &Control::look_at, this, &MapView::look_at);
    connect(control_->follow(), &MapFollow::changed, this, &MapView::follow_changed);
    connect(control_->follow(), &MapFollow::drive_changed, this, &MapView::drive_changed);
    connect(control_, &Control::orders_dropped, this, [this] { drop_press(); });
    connect(control_, &Control::map_changed, this, [this] {
      map_->show(control_->map());
      floors_.show(*control_->map());
      if (fitting_ && !busy()) fit(false);
      emit content_changed();
    });
    map_->show(control_->map());
    floors_.show(*control_->map());
  }
  emit control_changed();
  emit content_changed();
  refresh();
}

bool MapView::empty() const { return !control_ || control_->map()->tiles.empty(); }

void MapView::geometryChange(const QRectF& now, const QRectF& before) {
  GestureArea::geometryChange(now, before);
  map_->setSize(now.size());
  marks_->setSize(now.size());
  camera_.width = now.width();
  camera_.height = now.height();
  if (fitting_) fit(true);
  refresh_camera();
}

double MapView::slop() const { return kSlopMm * Theme::instance().mm(); }

void MapView::refresh() {
  if (!control_) return;
  if (fitting_ && !busy() && !aiming() && !drawing()) fit(false);
  move_with_robot();
  if (!busy() && !aiming()) {  // The place under a finger stays on the floor where it was pressed.
    floors_.show(control_->world(), control_->trails());
    show_floor();
  }
  const LayerScene layers{.world = &control_->world(),
                          .found = &control_->tabs()->found(),
                          .stairs = &control_->tabs()->staircases(),
                          .picked = control_->tabs()->picked(),
                          .project = [this](const Point3& at) { return camera_.to_screen(at.x, at.y); },
                          .floors = &floors_,
                          .floor = choice_.shown(),
                          .mm = Theme::instance().mm()};
  MarkList marks = layer_marks(layers);
  append(marks, marks_of({.world = &control_->world(),
                          .trails = &control_->trails(),
                          .camera = camera_,
                          .selection = control_->selection(),
                          .ghosts = ghosts_,
                          .sketch = control_->area()->sketch(),
                          .now = control_->now(),
                          .silent = control_->silent_for(),
                          .mm = Theme::instance().mm()}));
  append(marks, floor_marks(layers));
  if (const auto& place = control_->mark()->place())
    add_flag(marks, camera_.to_screen(place->x, place->y), Theme::instance().mm());
  if (aims() && needs_hold())
    add_ring(marks, {pressed_at().x(), pressed_at().y()}, held_share(), Theme::instance().mm());
  marks_->show(std::move(marks), camera_);
}

void MapView::refresh_camera() {
  map_->look(camera_);
  refresh();
  report_place();
}

void MapView::report_place() {
  if (!control_ || camera_.width < 10) return;
  std::optional<station::LookedAt> place;  // Who sees all of the map looks at no place of it.
  if (!fitting_)
    place = {camera_.x, camera_.y,
             std::min(std::hypot(camera_.width, camera_.height) / 2 / camera_.scale,
                      station::LookedAt::kMaxRadius)};
  control_->view_moved(place);
}

void MapView::set_fitting(bool fitting) {
  if (fitting == fitting_) return;
  fitting_ = fitting;
  emit fitting_changed();
}

void MapView::fit(bool at_once) {
  if (!control_ || camera_.width < 10) return;
  Point low{1e9, 1e9}, high{-1e9, -1e9};
  const auto add = [&](double x, double y) {
    if (!drawable(x, y)) return;
    low = {std::min(low.x, x), std::min(low.y, y)};
    high = {std::max(high.x, x), std::max(high.y, y)};
  };
  for (const station::Robot& robot : control_->world().robots)
    if (robot.located) add(robot.x, robot.y);
  for (const station::StationSummary& station : control_->world().stations)
    if (station.place) add((*station.place)[0], (*station.place)[1]);
  const station::TileMap& map = *control_->map();
  for (const auto& [place, tile] : map.tiles) {
    // The cells that are known, to an eighth of the tile.
    constexpr int kSide = station::MapTile::kSide, kStep = kSide / 8;
    if (tile->cells.size() != static_cast<std::size_t>(kSide) * kSide) continue;
    for (int row = 0; row < kSide; row += 4)
      for (int column = 0; column < kSide; column += 4) {
        if (tile->cells[static_cast<std::size_t>(row * kSide + column)] == station::MapTile::kUnknown)
          continue;
        const double x = place.first * kSide + column / kStep * kStep,
                     y = place.second * kSide + row / kStep * kStep;
        add(x * map.resolution, y * map.resolution);
        add((x + kStep) * map.resolution, (y + kStep) * map.resolution);
      }
  }
  if (low.x > high.x) return;
  if (!at_once && camera_.shows(low) && camera_.shows(high)) return;
  Camera next = camera_;
  next.fit(low, high, 12.0 * Theme::instance().mm());
  camera_ = next;
  map_->look(camera_);
}

void MapView::follow_changed() {
  const MapFollow& follow = *control_->follow();
  if (follow.robot() != std::exchange(followed_, follow.robot()) && !followed_.isEmpty()) {
    set_fitting(false);
    camera_.scale = std::max(camera_.scale, kLeastScale);
  }
  if (!follow.heading_up()) camera_.set_turn(0.0);
  if (fitting_) fit(true);
  refresh_camera();
}

void MapView::drive_changed(bool driving) {
  constexpr double kDrivenMm = 12.0;  // Length of the robot on the screen.
  if (!driving) {
    if (const auto before = before_drive_.end(*control_->follow())) {
      camera_.x = before->camera.x;
      camera_.y = before->camera.y;
      camera_.scale = before->camera.scale;
      set_fitting(before->fitting);
    }
    return;
  }
  before_drive_.begin(fitting_, camera_);
  if (const station::Robot* robot = control_->follow()->target())
    camera_.scale = std::max(camera_.scale, kDrivenMm * Theme::instance().mm() / extent_of(*robot));
}

Point MapView::follow_place() const {
  constexpr double kBehind = 0.64;  // Share of the height above a robot whose heading is up.
  return {(camera_.width - covered_right_) / 2,
          (camera_.height - covered_) * (control_->follow()->heading_up() ? kBehind : 0.5)};
}

void MapView::move_with_robot() {
  constexpr double kMoved = 0.5;  // Pixels that can be seen.
  const station::Robot* robot = control_->follow()->target();
  if (!robot || busy() || aiming() || drawing() || camera_.width < 10) return;
  Camera next = camera_;
  if (control_->follow()->heading_up()) next.look_along(robot->yaw);
  const Point to = follow_place(), from = camera_.to_screen(robot->x, robot->y);
  next.place({robot->x, robot->y}, to.x, to.y);
  const double turned = std::abs(next.turn - camera_.turn) * std::hypot(camera_.width, camera_.height) / 2;
  if (std::hypot(to.x - from.x, to.y - from.y) < kMoved && turned < kMoved) return;
  camera_ = next;
  map_->look(camera_);
  report_place();
}

void MapView::fitAll() {
  if (control_) control_->follow()->end();
  if (control_) control_->follow()->end_heading();
  set_fitting(true);
  fit(true);
  refresh_camera();
}

void MapView::zoomBy(double factor) { zoom(factor, {width() / 2, height() / 2}); }

void MapView::tap(const QPointF& at, bool add) {
  if (const Target* target = marks_->marks().target_at(at.x(), at.y()); control_ && target)
    control_->tap(*target, add);
}

void MapView::show_aim(const QPointF& at) {
  if (!control_) return;
  const Point place = camera_.to_map(at.x(), at.y());
  ghosts_ = control_->mark()->active() ? std::vector{place} : control_->goals_at(place);
  refresh();
}

void MapView::drop_aim() {
  ghosts_.clear();
  refresh();
}

void MapView::send_aim(const QPointF& at, bool held) {
  if (!control_) return;
  const Point place = camera_.to_map(at.x(), at.y());
  std::optional<double> height;  // Only one of several floors has to be named.
  if (const auto floor = shown_floor()) height = ground_at(*control_->map(), *floor, place);
  if (control_->mark()->active()) return control_->mark()->choose(place, height);
  control_->go_to(place, height, held);
}

void MapView::draw(const QPointF& from, const QPointF& to, bool done) {
  if (control_)
    control_->area()->draw(camera_.to_map(from.x(), from.y()), camera_.to_map(to.x(), to.y()), done);
}

void MapView::drop_drawing() {
  if (control_) control_->area()->drop();
}

std::optional<Floor> MapView::shown_floor() const {
  return choice_.shown() ? std::optional(floors_.floors()[*choice_.shown()]) : std::nullopt;
}

void MapView::show_floor() {
  choice_.update(floors_, control_->world(), control_->selection());
  map_->show_floor(shown_floor());
  if (std::exchange(floor_said_, floor()) != floor_said_) emit floor_changed();
}

void MapView::measure_reception() {
  if (control_->silent()) return;
  grid_.add(control_->world(), control_->tabs()->net());
  if (!reception()) return;
  map_->update();
  emit reception_changed();
}

void MapView::set_reception(bool shown) {
  if (!control_ || shown == reception()) return;
  map_->show_grid(shown ? &grid_ : nullptr);
  control_->tabs()->watch_network(shown);
  emit reception_changed();
}

QString MapView::reception_legend() const {
  if (grid_.cells().empty()) return "reception: no link report yet";
  return grid_.knows_signal() ? "worst signal heard here: dots from -75 dBm, lines from -85 dBm, full below"
                              : "most heartbeats lost here: dots up to 5 %, lines up to 20 %, full above";
}

void MapView::moveFloor(int steps) {
  choice_.move(steps, floors_);
  refresh();
}

void MapView::toggleFloor() {
  choice_.toggle();
  refresh();
}

void MapView::look_at(double x, double y, double z) {
  if (busy() || aiming()) return;                // The place under a finger stays there.
  if (control_->follow()->is_driving()) return;  // Who drives sees the driven robot.
  control_->follow()->end();
  set_fitting(false);
  choice_.show_height(z, floors_);
  camera_.scale = std::max(camera_.scale, kLeastScale);
  camera_.place({x, y}, camera_.width / 2, (camera_.height - covered_) / 2);
  refresh_camera();
}

void MapView::pan(const QPointF& by) {
  if (control_) control_->follow()->end();
  set_fitting(false);
  camera_.pan(by.x(), by.y());
  refresh_camera();
}

void MapView::zoom(double factor, const QPointF& about) {
  set_fitting(false);
  const bool follows = control_ && control_->follow()->target();
  const Point fixed = follows ? follow_place() : Point{about.x(), about.y()};
  camera_.zoom(factor, fixed.x, fixed.y);
  refresh_camera();
}

}  // namespace adit::gui

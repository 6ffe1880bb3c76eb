// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/map_view_3d.hpp"

#include <QPainter>
#include <QTimerEvent>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "basestation/gui/scene/height_legend.hpp"
#include "basestation/gui/scene/layer_marks.hpp"
#include "basestation/gui/scene/orbit_fit.hpp"
#include "basestation/gui/scene/orbit_marks.hpp"
#include "basestation/gui/scene/theme.hpp"

namespace adit::gui {
namespace {

constexpr int kSettledMs = 150;  // After the last movement the picture is painted in full detail.

}  // namespace

VoxelItem::VoxelItem(QQuickItem* parent) : QQuickPaintedItem(parent) {
  setOpaquePainting(true);
  connect(&Theme::instance(), &Theme::changed, this, [this] { update(); });
}

void VoxelItem::look(const OrbitCamera& camera, const Slice& slice, Detail3 detail) {
  camera_ = camera;
  slice_ = slice;
  detail_ = detail;
  update();
}

void VoxelItem::paint(QPainter* painter) {
  ++paintings_;
  painter_.paint(scene_, camera_, slice_, Theme::instance().palette(), detail_);
  const QImage image(reinterpret_cast<const uchar*>(painter_.pixels().data()), painter_.width(),
                     painter_.height(), painter_.width() * 4, QImage::Format_RGB32);
  painter->drawImage(QPointF(0, 0), image);
  const double mm = Theme::instance().mm();
  if (!scene_.empty()) draw_height_legend(*painter, painter_.colours(), {2.0 * mm, 2.0 * mm}, mm);
}

MapView3D::MapView3D(QQuickItem* parent)
    : GestureArea(parent), voxels_(new VoxelItem(this)), marks_(new MarkPainter(this)) {
  setClip(true);
  connect(this, &MapView3D::covered_changed, marks_, [this] { marks_->set_inset(covered_right_); });
}

void MapView3D::set_control(Control* control) {
  if (control == control_) return;
  if (control_)
    control_->disconnect(this), control_->mark()->disconnect(this), control_->tabs()->disconnect(this),
        control_->follow()->disconnect(this);
  control_ = control;
  if (control_) {
    connect(control_, &Control::shown, this, [this] {
      if (isVisible() && !move_with_robot()) refresh();
    });
    connect(control_->mark(), &MarkTool::changed, this, &MapView3D::refresh);
    connect(control_->tabs(), &TabState::findings_changed, this, &MapView3D::refresh);
    connect(control_, &Control::orders_dropped, this, [this] { drop_press(); });
    connect(control_, &Control::look_at, this, &MapView3D::look_at);
    connect(control_->follow(), &MapFollow::changed, this, &MapView3D::follow_changed);
    connect(control_->follow(), &MapFollow::drive_changed, this, &MapView3D::drive_changed);
    connect(control_, &Control::map_changed, this, [this] {
      if (isVisible()) show_map();
    });
  }
  emit control_changed();
  if (isVisible()) show_map();
}

void MapView3D::itemChange(ItemChange change, const ItemChangeData& data) {
  GestureArea::itemChange(change, data);
  if (change == ItemVisibleHasChanged && data.boolValue && control_) show_map();
}

void MapView3D::show_map() {
  voxels_->scene().show(*control_->map());
  floors_.show(*control_->map());
  if (!begun_ && !empty() && width() > 10) {
    begun_ = true;
    slice_.high = cut_above_robots();
    fit(true);
    emit cut_changed();
  }
  if (fitting_ && !busy() && !aiming()) fit(false);
  look(Detail3::fine);
  emit content_changed();
}

double MapView3D::cut_above_robots() const {
  double highest = -1e9;
  for (const station::Robot& robot : control_->world().robots)
    if (robot.located && std::abs(robot.z) < 1e5F) highest = std::max<double>(highest, robot.z);
  return highest > -1e8 ? highest + kHeadroom : 1e9;
}

void MapView3D::geometryChange(const QRectF& now, const QRectF& before) {
  GestureArea::geometryChange(now, before);
  voxels_->setSize(now.size());
  marks_->setSize(now.size());
  camera_.width = now.width();
  camera_.height = now.height();
  if (fitting_ && begun_ && !busy() && !aiming()) fit(true);
  if (isVisible() && control_) show_map();
}

double MapView3D::slop() const { return kSlopMm * Theme::instance().mm(); }

void MapView3D::refresh() {
  if (!control_ || !isVisible()) return;
  if (!busy() && !aiming()) show_floor();
  const auto project = [this](const Point3& place) -> std::optional<Point> {
    const auto seen = camera_.project(place);
    return seen ? std::optional(seen->at) : std::nullopt;
  };
  MarkList marks = layer_marks({.world = &control_->world(),
                                .found = &control_->tabs()->found(),
                                .stairs = &control_->tabs()->staircases(),
                                .picked = control_->tabs()->picked(),
                                .project = project,
                                .from_side = true,
                                .mm = Theme::instance().mm()});
  append(marks, orbit_marks({.world = &control_->world(),
                             .trails = &control_->trails(),
                             .camera = camera_,
                             .slice = slice_,
                             .selection = control_->selection(),
                             .ghosts = ghosts_,
                             .silent = control_->silent_for(),
                             .mm = Theme::instance().mm()}));
  if (const auto& place = control_->mark()->place())
    if (const auto at = project({place->x, place->y, control_->mark()->height()}))
      add_flag(marks, *at, Theme::instance().mm());
  if (aims() && needs_hold())
    add_ring(marks, {pressed_at().x(), pressed_at().y()}, held_share(), Theme::instance().mm());
  marks_->show(std::move(marks), {.scale = camera_.focal() / camera_.distance}, true);
}

void MapView3D::look(Detail3 detail) {
  voxels_->look(camera_, slice_, detail);
  if (detail == Detail3::moving) settled_.start(kSettledMs, this);
  refresh();
}

void MapView3D::timerEvent(QTimerEvent* event) {
  if (event->timerId() != settled_.timerId()) return GestureArea::timerEvent(event);
  settled_.stop();
  look(Detail3::fine);
}

void MapView3D::set_fitting(bool fitting) {
  if (fitting == fitting_) return;
  fitting_ = fitting;
  emit fitting_changed();
}

std::vector<Point3> MapView3D::shown_corners() const {
  std::vector<Point3> corners = voxels_->scene().corners(slice_.low, slice_.high);
  const auto add = [&](double x, double y, double z) {
    if (drawable(x, y) && std::abs(z) < 1e5 && stands_in(slice_, z)) corners.push_back({x, y, z});
  };
  for (const station::Robot& robot : control_->world().robots)
    if (robot.located) add(robot.x, robot.y, robot.z);
  for (const station::StationSummary& station : control_->world().stations)
    if (station.place) add((*station.place)[0], (*station.place)[1], (*station.place)[2]);
  return corners;
}

void MapView3D::fit(bool at_once) {
  if (!control_ || empty() || width() < 10) return;
  const std::vector<Point3> corners = shown_corners();
  if (!at_once)
    if (const auto box = box_of(camera_, corners);
        box && box->low.x >= 0 && box->low.y >= 0 && box->high.x <= width() && box->high.y <= height())
      return;
  const double mm = Theme::instance().mm();
  // The legend, the buttons, and names below robots.
  camera_ = fitted(camera_, corners, {22.0 * mm, 3.0 * mm, 27.0 * mm, 5.0 * mm + covered_});
}

void MapView3D::fitAll() {
  if (empty()) return;
  control_->follow()->end();
  control_->follow()->end_heading();
  set_fitting(true);
  fit(true);
  look(Detail3::fine);
}

void MapView3D::follow_changed() {
  if (!followed().isEmpty()) set_fitting(false);
  if (!isVisible() || move_with_robot()) return;
  if (fitting_) fit(true);
  look(Detail3::fine);
}

void MapView3D::drive_changed(bool driving) {
  constexpr double kNear = 12.0;  // m
  if (!driving) {
    if (const auto before = before_drive_.end(*control_->follow())) {
      camera_.target = before->camera.target;
      camera_.yaw = before->camera.yaw;
      camera_.distance = before->camera.distance;
      set_fitting(before->fitting);
    }
    return;
  }
  before_drive_.begin(fitting_, camera_);
  camera_.distance = std::min(camera_.distance, kNear);
}

bool MapView3D::move_with_robot() {
  constexpr double kMoved = 0.5;  // Pixels that can be seen.
  const station::Robot* robot = control_->follow()->target();
  if (!robot || busy() || aiming()) return false;
  OrbitCamera next = camera_;
  if (control_->follow()->heading_up()) next.yaw = robot->yaw;
  next.target = {robot->x, robot->y, robot->z};
  next.pan(-covered_right_ / 2, -covered_ / 2);
  const Point3 by = next.target - camera_.target;
  const double turned = std::abs(std::remainder(next.yaw - camera_.yaw, 2.0 * std::numbers::pi)) * width();
  if (turned < kMoved && std::hypot(by.x, by.y, by.z) * camera_.focal() / camera_.distance < kMoved)
    return false;
  camera_ = next;
  look(Detail3::moving);
  return true;
}

void MapView3D::show_floor() {
  (void)floors_.show(control_->world(), control_->trails());
  choice_.update(floors_, control_->world(), control_->selection());
  const auto shown = choice_.shown();
  const std::optional<Floor> floor = shown ? std::optional(floors_.floors()[*shown]) : std::nullopt;
  if (floor != floor_) {
    const bool was_shown = floor_.has_value();
    floor_ = floor;
    if (floor_)
      slice_ = slice_of(*floor_);
    else if (was_shown)
      slice_ = {.high = cut_above_robots()};
    if (fitting_) fit(true);
    voxels_->look(camera_, slice_, Detail3::fine);
    emit cut_changed();
  }
  if (std::exchange(floor_said_, this->floor()) != floor_said_) emit floor_changed();
}

void MapView3D::moveFloor(int steps) {
  choice_.move(steps, floors_);
  refresh();
}

void MapView3D::toggleFloor() {
  choice_.toggle();
  refresh();
}

void MapView3D::look_at(double x, double y, double height) {
  constexpr double kNearEnough = 15.0;                                 // m
  if (busy() || aiming() || control_->follow()->is_driving()) return;  // Who drives sees the driven robot.
  double z = std::abs(height) < 1e5 ? height : camera_.target.z;
  if (!(std::abs(height) < 1e5))
    for (const std::string& name : control_->selection())
      if (const station::Robot* robot = control_->world().robot(name); robot && std::abs(robot->z) < 1e5F)
        z = robot->z;
  set_fitting(false);
  control_->follow()->end();
  camera_.target = {x, y, z};
  camera_.distance = std::min(camera_.distance, kNearEnough);
  camera_.pan(0, -covered_ / 2);
  look(Detail3::fine);
}

void MapView3D::moveCut(int steps) {
  if (!control_) return;
  if (!cutting()) slice_.high = cut_above_robots();
  if (!cutting()) return;
  slice_.high += steps * kCutStep;
  look(Detail3::fine);
  emit cut_changed();
}

void MapView3D::toggleCut() {
  if (!control_) return;
  slice_.high = cutting() ? 1e9 : cut_above_robots();
  look(Detail3::fine);
  emit cut_changed();
}

void MapView3D::tap(const QPointF& at, bool add) {
  if (const Target* target = marks_->marks().target_at(at.x(), at.y()); control_ && target)
    control_->tap(*target, add);
}

std::optional<Point3> MapView3D::place_at(const QPointF& at) const {
  return voxels_->painter().pick(at.x(), at.y());
}

void MapView3D::show_aim(const QPointF& at) {
  ghosts_.clear();
  if (const auto place = control_ ? place_at(at) : std::nullopt) {
    if (control_->mark()->active())
      ghosts_.push_back(*place);
    else
      for (const Point& goal : control_->goals_at({place->x, place->y}))
        ghosts_.push_back({goal.x, goal.y, place->z});
  }
  refresh();
}

void MapView3D::drop_aim() {
  ghosts_.clear();
  refresh();
}

void MapView3D::send_aim(const QPointF& at, bool held) {
  if (!control_) return;
  const auto place = place_at(at);
  const bool marks = control_->mark()->active();
  if (!place)
    control_->say(QString(marks ? "Mark" : "Go to") + ": nothing of the map is there", "refused");
  else if (marks)
    control_->mark()->choose({place->x, place->y}, place->z);
  else
    control_->go_to({place->x, place->y}, place->z, held);
}

void MapView3D::pan(const QPointF& by) {
  set_fitting(false);
  if (pinching() || sliding()) {
    control_->follow()->end();
    camera_.pan(by.x(), by.y());
  } else {
    if (std::abs(by.x()) > 2.0 * std::abs(by.y())) control_->follow()->end_heading();
    camera_.orbit(by.x(), by.y());
  }
  look(Detail3::moving);
}

void MapView3D::zoom(double factor, const QPointF&) {
  set_fitting(false);
  camera_.zoom(factor);
  look(Detail3::moving);
}

}  // namespace adit::gui

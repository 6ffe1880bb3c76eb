// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/map_view_3d.hpp"

#include <QPainter>
#include <QTimerEvent>
#include <algorithm>

#include "basestation/gui/scene/layer_marks.hpp"
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
}

MapView3D::MapView3D(QQuickItem* parent)
    : GestureArea(parent), voxels_(new VoxelItem(this)), marks_(new MarkPainter(this)) {
  setClip(true);
}

void MapView3D::set_control(Control* control) {
  if (control == control_) return;
  if (control_)
    control_->disconnect(this), control_->mark()->disconnect(this), control_->tabs()->disconnect(this);
  control_ = control;
  if (control_) {
    connect(control_, &Control::shown, this, &MapView3D::refresh);
    connect(control_->mark(), &MarkTool::changed, this, &MapView3D::refresh);
    connect(control_->tabs(), &TabState::findings_changed, this, &MapView3D::refresh);
    connect(control_, &Control::orders_dropped, this, [this] { drop_press(); });
    connect(control_, &Control::look_at, this, &MapView3D::look_at);
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
  if (!fitted_ && !empty() && width() > 10) {
    fitAll();
    slice_.high = cut_above_robots();
    emit cut_changed();
  }
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
  if (isVisible() && control_) show_map();
}

double MapView3D::slop() const { return kSlopMm * Theme::instance().mm(); }

void MapView3D::refresh() {
  if (!control_ || !isVisible()) return;
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
                             .selection = control_->selection(),
                             .ghosts = ghosts_,
                             .silent = control_->silent_for(),
                             .mm = Theme::instance().mm()}));
  if (const auto& place = control_->mark()->place())
    if (const auto at = project({place->x, place->y, control_->mark()->height()}))
      add_flag(marks, *at, Theme::instance().mm());
  if (aims() && needs_hold())
    add_ring(marks, {pressed_at().x(), pressed_at().y()}, held_share(), Theme::instance().mm());
  marks_->show(std::move(marks), {.scale = 0.0});
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

void MapView3D::fitAll() {
  if (empty()) return;
  fitted_ = true;
  camera_.fit(voxels_->scene().low(), voxels_->scene().high());
  look(Detail3::fine);
}

void MapView3D::look_at(double x, double y, double height) {
  constexpr double kNearEnough = 15.0;  // m
  if (busy() || aiming()) return;
  double z = std::abs(height) < 1e5 ? height : camera_.target.z;
  if (!(std::abs(height) < 1e5))
    for (const std::string& name : control_->selection())
      if (const station::Robot* robot = control_->world().robot(name); robot && std::abs(robot->z) < 1e5F)
        z = robot->z;
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
  if (pinching() || sliding())
    camera_.pan(by.x(), by.y());
  else
    camera_.orbit(by.x(), by.y());
  look(Detail3::moving);
}

void MapView3D::zoom(double factor, const QPointF&) {
  camera_.zoom(factor);
  look(Detail3::moving);
}

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/camera_item.hpp"

#include <QPainter>
#include <QPointer>
#include <QQuickWindow>
#include <algorithm>

namespace adit::gui {

CameraItem::CameraItem(QQuickItem* parent) : QQuickPaintedItem(parent) {
  setOpaquePainting(true);
  aging_.setInterval(kAgeStep);
  connect(&aging_, &QTimer::timeout, this, [this] {
    emit shown_changed();
    if (is_stale()) update();
  });
  retry_.setInterval(kRetry);
  retry_.setSingleShot(true);
  connect(&retry_, &QTimer::timeout, this, [this] { ask(); });
}

void CameraItem::set_feeds(CameraFeeds* feeds) {
  if (feeds == feeds_) return;
  feeds_ = feeds;
  restart();
}

void CameraItem::set_robot(const QString& robot) {
  if (robot == robot_) return;
  robot_ = robot;
  restart();
}

void CameraItem::set_camera(const QString& camera) {
  if (camera == camera_) return;
  camera_ = camera;
  restart();
}

void CameraItem::set_active(bool active) {
  if (active == active_) return;
  active_ = active;
  emit source_changed();
  ask_soon();
}

void CameraItem::itemChange(ItemChange change, const ItemChangeData& data) {
  QQuickPaintedItem::itemChange(change, data);
  if (change == ItemVisibleHasChanged) restart();
}

/// A picture of another robot must never stay in view.
void CameraItem::restart() {
  ++run_;
  asked_ = false;
  image_ = {};
  unmarked_ = {};
  problem_.clear();
  number_ = 0;
  period_ = 0;
  retry_.stop();
  const bool active = feeds_ != nullptr && !robot_.isEmpty() && isVisible();
  active ? aging_.start() : aging_.stop();
  ask_soon();
  update();
  emit source_changed();
  emit shown_changed();
}

/// Several properties change together.
void CameraItem::ask_soon() {
  QTimer::singleShot(rest_, this, [this, run = run_] {
    if (run == run_) ask();
  });
}

void CameraItem::ask() {
  if (asked_ || !active_ || feeds_ == nullptr || robot_.isEmpty() || !isVisible()) return;
  asked_ = true;
  const double shown = width() * (window() != nullptr ? window()->effectiveDevicePixelRatio() : 1.0);
  const double pixels = limit_ > 0 ? std::min<double>(shown, limit_) : shown;
  feeds_->next({.robot = robot_.toStdString(),
                .camera = camera_.toStdString(),
                .width = static_cast<std::uint16_t>(std::clamp(pixels, 64.0, 1920.0)),
                .rate = static_cast<float>(rate_),
                .after = number_},
               unmarked_, [self = QPointer(this), run = run_](const ShownPicture& picture) {
                 if (self) self->take(run, picture);
               });
}

void CameraItem::take(std::uint64_t run, const ShownPicture& picture) {
  if (run != run_) return;
  asked_ = false;
  problem_ = picture.problem;
  if (picture.number != 0) number_ = picture.number;
  if (!picture.image.isNull()) {
    period_ = image_.isNull() ? 0.0 : std::min(10.0, static_cast<double>(since_.elapsed()) / 1000.0);
    image_ = picture.image;
    unmarked_ = picture.unmarked;
    missing_ = picture.missing;
    delay_ = picture.age;
    since_.start();
    update();
  }
  emit shown_changed();
  if (!picture.problem.isEmpty()) return retry_.start(kRetry);
  if (picture.number == 0) return retry_.start(kPause);  // The station may be too busy to wait.
  ask();
}

double CameraItem::age() const {
  return image_.isNull() ? 0.0 : delay_ + static_cast<double>(since_.elapsed()) / 1000.0;
}

QString CameraItem::caption() const {
  const QString name = camera_.isEmpty() ? robot_ : robot_ + " " + camera_;
  if (image_.isNull()) return name + ": " + (problem_.isEmpty() ? "waits for a picture" : problem_);
  return name + ", " + age_text();
}

QString CameraItem::age_text() const {
  return image_.isNull() ? QString() : short_age() + " old" + (missing_ > 0 ? ", parts lost" : "");
}

QString CameraItem::short_age() const {
  const double old = age();
  return image_.isNull() ? QString() : QString::number(old, 'f', old < 10 ? 1 : 0) + " s";
}

void CameraItem::paint(QPainter* painter) {
  painter->fillRect(boundingRect(), QColor(20, 20, 20));
  if (image_.isNull() || width() < 1 || height() < 1) return;
  const QSizeF size = QSizeF(image_.size()).scaled(boundingRect().size(), Qt::KeepAspectRatio);
  const QRectF to(QPointF((width() - size.width()) / 2, (height() - size.height()) / 2), size);
  painter->setRenderHint(QPainter::SmoothPixmapTransform);
  if (!is_stale()) return painter->drawImage(to, image_);
  painter->drawImage(to, image_.convertToFormat(QImage::Format_Grayscale8));
  painter->fillRect(to, QColor(20, 20, 20, 110));
}

}  // namespace adit::gui

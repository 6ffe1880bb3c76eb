// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QBasicTimer>
#include <QImage>
#include <optional>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/scene/before_drive.hpp"
#include "basestation/gui/scene/floor_choice.hpp"
#include "basestation/gui/scene/gesture_area.hpp"
#include "basestation/gui/scene/mark_painter.hpp"
#include "basestation/gui/scene/orbit_camera.hpp"
#include "basestation/gui/scene/voxel_painter.hpp"

namespace adit::gui {

/// The picture of the voxels, which is painted again only if the camera or the map changes.
class VoxelItem : public QQuickPaintedItem {
  Q_OBJECT

 public:
  explicit VoxelItem(QQuickItem* parent = nullptr);
  VoxelScene& scene() { return scene_; }
  const VoxelScene& scene() const { return scene_; }
  /// The picture is wrong now.
  void look(const OrbitCamera& camera, const Slice& slice, Detail3 detail);
  const VoxelPainter& painter() const { return painter_; }
  int paintings() const { return paintings_; }
  void paint(QPainter* painter) override;

 private:
  VoxelScene scene_{};
  VoxelPainter painter_{};
  OrbitCamera camera_{};
  Slice slice_{};
  Detail3 detail_{Detail3::fine};
  int paintings_{0};
};

/// The map from the side with all marks. One finger or the mouse turns it, two fingers, the middle or the
/// right button move it; a tap selects a robot, and a long press sends the selected ones to the place under
/// the finger.
class MapView3D : public adit::gui::GestureArea {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(adit::gui::Control* control READ control WRITE set_control NOTIFY control_changed)
  Q_PROPERTY(bool empty READ empty NOTIFY content_changed)
  /// Height at the lower edge that something else covers, pixels.
  Q_PROPERTY(double covered MEMBER covered_ NOTIFY covered_changed)
  /// Width at the right edge that something else covers, pixels. A robot that is followed stays beside it.
  Q_PROPERTY(double coveredRight MEMBER covered_right_ NOTIFY covered_changed)
  /// Height above which nothing is shown, m.
  Q_PROPERTY(double cut READ cut NOTIFY cut_changed)
  Q_PROPERTY(bool cutting READ cutting NOTIFY cut_changed)
  /// Whether all that is shown stays in view; ends when the operator moves it.
  Q_PROPERTY(bool fitting READ fitting NOTIFY fitting_changed)
  /// The floor that alone is shown, in words; empty: there are not two.
  Q_PROPERTY(QString floor READ floor NOTIFY floor_changed)
  Q_PROPERTY(bool floorAutomatic READ floor_automatic NOTIFY floor_changed)

 public:
  static constexpr double kCutStep = 0.5;  ///< m
  static constexpr double kHeadroom =
      1.6;  ///< Of the first cut above the robots, so that no ceiling hides them, m.

  explicit MapView3D(QQuickItem* parent = nullptr);

  Control* control() const { return control_; }
  void set_control(Control* control);
  bool empty() const { return voxels_->scene().empty(); }
  double cut() const { return slice_.high; }
  bool cutting() const { return slice_.high < 1e8; }
  const Slice& slice() const { return slice_; }
  bool fitting() const { return fitting_; }
  /// The robot that stays in the middle; empty: none.
  QString followed() const { return control_ ? control_->follow()->robot() : QString(); }
  QString floor() const { return QString::fromStdString(choice_.label()); }
  bool floor_automatic() const { return choice_.kind() == FloorChoice::Kind::automatic; }
  /// Corners of what is shown, map frame, m.
  std::vector<Point3> shown_corners() const;
  const OrbitCamera& camera() const { return camera_; }
  const MarkList& marks() const { return marks_->marks(); }
  const VoxelItem& voxels() const { return *voxels_; }

  Q_INVOKABLE void fitAll();
  Q_INVOKABLE void zoomBy(double factor) { zoom(factor, {}); }
  /// Moves the cut by so many steps.
  Q_INVOKABLE void moveCut(int steps);
  /// Shows all heights, or cuts above the robots again.
  Q_INVOKABLE void toggleCut();
  /// Shows the floor so many above alone.
  Q_INVOKABLE void moveFloor(int steps);
  /// Shows the floor of the selected robot alone, or all of them.
  Q_INVOKABLE void toggleFloor();

 signals:
  void control_changed();
  void content_changed();
  void cut_changed();
  void covered_changed();
  void fitting_changed();
  void floor_changed();

 protected:
  void geometryChange(const QRectF& now, const QRectF& before) override;
  void itemChange(ItemChange change, const ItemChangeData& data) override;
  bool holds_place() const override { return control_ && control_->follow()->target() != nullptr; }
  bool aiming() const override { return control_ && (control_->aiming() || control_->mark()->active()); }
  double slop() const override;
  void tap(const QPointF& at, bool add) override;
  void show_aim(const QPointF& at) override;
  void drop_aim() override;
  bool needs_hold() const override {
    return control_ && control_->goto_is_held() && !control_->mark()->active();
  }
  void send_aim(const QPointF& at, bool held) override;
  void pan(const QPointF& by) override;
  void zoom(double factor, const QPointF& about) override;
  void timerEvent(QTimerEvent* event) override;

 private:
  void refresh();  ///< The marks.
  void look(Detail3 detail);
  void look_at(double x, double y, double z);
  void show_map();
  std::optional<Point3> place_at(const QPointF& at) const;
  double cut_above_robots() const;
  void fit(bool at_once);
  void set_fitting(bool fitting);
  void follow_changed();
  void drive_changed(bool driving);
  bool move_with_robot();  ///< False: the view stays.
  void show_floor();

  Control* control_{};
  VoxelItem* voxels_{};
  MarkPainter* marks_{};
  OrbitCamera camera_{};
  Slice slice_{};
  bool begun_{false};  ///< The first map was shown.
  bool fitting_{true};
  Floors floors_{};
  FloorChoice choice_{FloorChoice::Kind::all};
  QString floor_said_{};
  std::optional<Floor> floor_{};  ///< As the slice shows it.
  double covered_{0.0}, covered_right_{0.0};
  BeforeDrive<OrbitCamera> before_drive_{};
  std::vector<Point3> ghosts_{};
  QBasicTimer settled_{};  ///< Runs while the camera moves.
};

}  // namespace adit::gui

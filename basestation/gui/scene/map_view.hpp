// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <optional>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/scene/before_drive.hpp"
#include "basestation/gui/scene/floor_choice.hpp"
#include "basestation/gui/scene/gesture_area.hpp"
#include "basestation/gui/scene/map_item_2d.hpp"
#include "basestation/gui/scene/mark_painter.hpp"

namespace adit::gui {

/// The map from above with all marks, and what fingers do on it.
class MapView : public adit::gui::GestureArea {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(adit::gui::Control* control READ control WRITE set_control NOTIFY control_changed)
  /// Whether the view is adjusted so that all robots and the map stay in it; ends when the operator moves it.
  Q_PROPERTY(bool fitting READ fitting NOTIFY fitting_changed)
  Q_PROPERTY(bool empty READ empty NOTIFY content_changed)
  /// The floor that is shown, in words; empty: there are not two.
  Q_PROPERTY(QString floor READ floor NOTIFY floor_changed)
  Q_PROPERTY(bool floorAutomatic READ floor_automatic NOTIFY floor_changed)
  /// Whether the reception from robots is drawn where they were.
  Q_PROPERTY(bool reception READ reception WRITE set_reception NOTIFY reception_changed)
  Q_PROPERTY(QString receptionLegend READ reception_legend NOTIFY reception_changed)
  /// Height at the lower edge that something else covers, pixels.
  Q_PROPERTY(double covered MEMBER covered_ NOTIFY covered_changed)
  /// Width at the right edge that something else covers, pixels. A robot that is followed stays beside it.
  Q_PROPERTY(double coveredRight MEMBER covered_right_ NOTIFY covered_changed)

 public:
  explicit MapView(QQuickItem* parent = nullptr);

  Control* control() const { return control_; }
  void set_control(Control* control);
  bool fitting() const { return fitting_; }
  bool empty() const;  ///< There is no map yet.
  const Camera& camera() const { return camera_; }
  const MarkList& marks() const { return marks_->marks(); }

  QString floor() const { return QString::fromStdString(choice_.label()); }
  bool floor_automatic() const { return choice_.kind() == FloorChoice::Kind::automatic; }
  bool reception() const { return map_->grid() != nullptr; }
  void set_reception(bool shown);
  QString reception_legend() const;
  const SignalGrid& grid() const { return grid_; }
  const MapItem2D& tiles() const { return *map_; }

  /// Shows the floor so many above.
  Q_INVOKABLE void moveFloor(int steps);
  /// Follows the selected robot, or shows all floors.
  Q_INVOKABLE void toggleFloor();
  Q_INVOKABLE void fitAll();
  Q_INVOKABLE void zoomBy(double factor);

 signals:
  void control_changed();
  void fitting_changed();
  void content_changed();
  void covered_changed();
  void floor_changed();
  void reception_changed();

 protected:
  void geometryChange(const QRectF& now, const QRectF& before) override;
  bool aiming() const override { return control_ && (control_->aiming() || control_->mark()->active()); }
  bool holds_place() const override { return control_ && control_->follow()->target() != nullptr; }
  bool drawing() const override { return control_ && control_->area()->active(); }
  double slop() const override;
  void tap(const QPointF& at, bool add) override;
  void show_aim(const QPointF& at) override;
  void drop_aim() override;
  bool needs_hold() const override {
    return control_ && control_->goto_is_held() && !control_->mark()->active();
  }
  void send_aim(const QPointF& at, bool held) override;
  void draw(const QPointF& from, const QPointF& to, bool done) override;
  void drop_drawing() override;
  void pan(const QPointF& by) override;
  void zoom(double factor, const QPointF& about) override;

 private:
  void follow_changed();
  void drive_changed(bool driving);
  /// Where a robot that is followed is on the screen, pixels.
  Point follow_place() const;
  /// Keeps the robot that is followed at its place of the screen.
  void move_with_robot();
  void report_place();                         ///< What of the map is in view, to the station.
  void look_at(double x, double y, double z);  ///< Brings a place of the map frame, m, into the middle.
  void refresh();                              ///< The marks.
  void refresh_camera();                       ///< The map and the marks.
  void measure_reception();
  /// Shows the chosen floor.
  void show_floor();
  std::optional<Floor> shown_floor() const;  ///< Nothing: all of them.
  void set_fitting(bool fitting);
  /// Adjusts the view if something is outside of it, or at once.
  void fit(bool at_once);

  Control* control_{};
  MapItem2D* map_{};
  MarkPainter* marks_{};
  Camera camera_{};
  bool fitting_{true};
  double covered_{0.0}, covered_right_{0.0};
  QString followed_{};  ///< Robot for which the scale was set.
  BeforeDrive<Camera> before_drive_{};
  SignalGrid grid_{};
  Floors floors_{};
  FloorChoice choice_{};
  QString floor_said_{};
  std::vector<Point> ghosts_{};
};

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QString>

namespace adit::station {
struct Robot;
}

namespace adit::gui {

class Control;

/// Which robot the map keeps in view, and whether its heading is up. While a robot is driven by hand, the map
/// follows that one, with its heading up unless the operator chose otherwise.
class MapFollow : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  /// The robot that is followed; empty: none.
  Q_PROPERTY(QString robot READ robot NOTIFY changed)
  Q_PROPERTY(bool headingUp READ heading_up NOTIFY changed)

 public:
  explicit MapFollow(Control& control) : control_(control) {}

  /// Follows the driven robot, or the selected one, or none any more.
  Q_INVOKABLE void toggle();
  /// The heading of the followed robot is up, or north.
  Q_INVOKABLE void toggleHeading();
  /// The operator moved the map: it follows no robot, and stays turned as it is.
  void end();
  /// The operator turned the map: no heading is up.
  void end_heading();
  /// Notices that driving began or ended.
  void refresh_drive();

  const QString& robot() const { return robot_; }
  bool heading_up() const { return heading_up_; }
  bool is_driving() const { return !driven_.isEmpty(); }
  /// Whether the map still followed the driven robot when driving ended: the operator did not move it.
  bool followed_to_the_end() const { return followed_to_the_end_; }
  /// The robot that is followed; null: none, or its place is not known.
  const station::Robot* target() const;

 signals:
  /// Driving began or ended; `changed` comes after it.
  void drive_changed(bool driving);
  void changed();

 private:
  Control& control_;
  QString robot_{}, driven_{};
  QString before_{};  ///< The robot that was followed before driving began.
  bool heading_up_{false};
  bool followed_to_the_end_{false};
  bool heading_up_driving_{true};  ///< As the operator chose it while driving.
};

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QStringList>
#include <vector>

#include "basestation/gui/bridge/details.hpp"
#include "basestation/gui/bridge/row_model.hpp"

namespace adit::gui {

class Control;

/// The details of the selected robots, for QML.
class DetailList : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  Q_PROPERTY(QAbstractItemModel* rows READ rows CONSTANT)
  /// The robot of which pictures can be shown: the selected one, if it has a camera; else empty.
  Q_PROPERTY(QString cameraRobot READ camera_robot NOTIFY cameras_changed)
  Q_PROPERTY(QStringList cameras READ cameras NOTIFY cameras_changed)
  Q_PROPERTY(QString cameraNames READ camera_names NOTIFY cameras_changed)
  /// The camera whose pictures are shown while cameraOn; empty: the robot has none.
  Q_PROPERTY(QString camera READ camera NOTIFY cameras_changed)
  Q_PROPERTY(bool cameraOn READ camera_on WRITE set_camera_on NOTIFY cameras_changed)
  Q_PROPERTY(QString cameraText READ camera_text NOTIFY cameras_changed)
  Q_PROPERTY(bool open READ is_open WRITE set_open NOTIFY open_changed)

 public:
  explicit DetailList(Control& control);

  /// Reads them again, if they are open.
  void refresh();
  const std::vector<Detail>& details() const { return details_; }
  /// Runs the order of a row; `held`: by press and hold.
  Q_INVOKABLE void act(int row, bool held);

  QAbstractItemModel* rows() { return &rows_; }
  bool is_open() const { return open_; }
  void set_open(bool open);

  const QString& camera_robot() const { return camera_robot_; }
  const QStringList& cameras() const { return cameras_; }
  QString camera_names() const { return cameras_.join(", "); }
  const QString& camera() const { return camera_; }
  bool camera_on() const { return camera_on_; }
  void set_camera_on(bool on);
  /// Size, rate and load of the pictures that arrive.
  const QString& camera_text() const { return camera_text_; }
  /// Shows the next camera of the robot.
  Q_INVOKABLE void next_camera();

 signals:
  void cameras_changed();
  void open_changed();

 private:
  Control& control_;
  std::vector<Detail> details_{};
  RowModel rows_;
  bool open_{false};
  QString camera_robot_{}, camera_{}, camera_text_{};
  QStringList cameras_{};
  bool camera_on_{false};
  void refresh_cameras();
};

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QSize>
#include <QTimer>

#include "basestation/gui/bridge/camera_plan.hpp"
#include "basestation/gui/bridge/row_model.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::gui {

class Control;

/// The grid of all cameras, for QML: one is sharp, the others are thumbnails. It does nothing while no one
/// shows it.
class CameraGrid : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  Q_PROPERTY(QAbstractItemModel* tiles READ tiles CONSTANT)
  /// The sharp camera, as one row with the roles of `tiles`; none: no robot has a camera.
  Q_PROPERTY(QAbstractItemModel* large READ large CONSTANT)
  Q_PROPERTY(int count READ count NOTIFY changed)
  Q_PROPERTY(QString summary READ summary NOTIFY changed)
  /// Robots without a camera, in words.
  Q_PROPERTY(QString without READ without NOTIFY changed)

 public:
  static constexpr int kSeenMs = 100;     ///< Until what came into sight is asked for.
  static constexpr int kTurnMs = 20'000;  ///< Of thumbnails that share a link: two pictures each.

  explicit CameraGrid(Control& control);

  /// Reads the world and the network again, if the grid is shown.
  void refresh();
  /// Notices that a front end switches a camera on or off.
  void add_command(const station::CommandEvent& event);
  /// A part of the window begins or ends to show the grid.
  Q_INVOKABLE void watch(bool shown);
  /// A thumbnail comes into sight, or leaves it.
  Q_INVOKABLE void see(const QString& robot, const QString& camera, bool in_sight);
  /// Makes a camera the sharp one.
  Q_INVOKABLE void choose(const QString& robot, const QString& camera);
  /// Makes the camera so many places after the sharp one the sharp one.
  Q_INVOKABLE void step(int by);
  /// Asks for the pictures of a camera again, or switches it off by the command `camera`.
  Q_INVOKABLE void switchOn(const QString& robot, const QString& camera, bool on);

  /// Size of a tile with its gap, pixels: as large as all of them fit into that space, or as small as one can
  /// be read. `mm`: pixels per mm.
  Q_INVOKABLE QSizeF tileFor(int tiles, double width, double height, double mm) const;

  bool is_shown() const { return watchers_ > 0; }
  QAbstractItemModel* tiles() { return &tiles_; }
  QAbstractItemModel* large() { return &large_; }
  const CameraName& sharp() const { return sharp_; }
  int count() const { return tiles_.rowCount(); }
  QString summary() const { return text_of(plan_.summary); }
  QString without() const;
  const CameraPlan& plan() const { return plan_; }

 signals:
  void changed();

 private:
  void follow_selection();
  void set_off(const CameraName& camera, bool off);

  Control& control_;
  RowModel tiles_, large_;
  CameraPlan plan_{};
  CameraName sharp_{};
  std::string selected_{};  ///< The robot whose camera the selection made the sharp one.
  std::set<CameraName> off_{};
  std::set<CameraName> ending_{};         ///< Switched off by this grid; the station has not answered yet.
  std::multiset<CameraName> in_sight_{};  ///< One for each of its thumbnails.
  std::size_t turn_{};
  QTimer turns_{}, seen_{};
  int watchers_{0};
};

}  // namespace adit::gui

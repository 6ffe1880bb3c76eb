// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <string>
#include <vector>

#include "basestation/gui/scene/camera.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

class Control;

/// A name for a new area that no robot has: "a1", "a2", ...
std::string free_area_name(const station::World& world);

/// Draws an area on the map for the selected robots: a rectangle from corner to corner, then what it means.
class AreaTool : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  /// The next drag over the map draws.
  Q_PROPERTY(bool active READ active WRITE set_active NOTIFY changed)
  /// A rectangle is drawn and waits for its meaning.
  Q_PROPERTY(bool ready READ ready NOTIFY changed)
  Q_PROPERTY(QString text READ text NOTIFY changed)
  /// Its robots are so many that its buttons are held.
  Q_PROPERTY(bool held READ is_held NOTIFY changed)

 public:
  static constexpr double kLeastSide = 0.2;  ///< A smaller rectangle is none, m.

  explicit AreaTool(Control& control);

  bool active() const { return active_; }
  void set_active(bool active);
  bool ready() const { return ready_; }
  QString text() const;
  bool is_held() const;

  /// The selection may have changed.
  void refresh();
  /// From the map: two corners while the finger moves, map frame, m; `done`: it was lifted.
  void draw(const Point& from, const Point& to, bool done);
  void drop();
  /// The corners that are drawn; empty: none.
  std::vector<Point> sketch() const;
  /// Gives the rectangle to the robots: keep_out, keep_in or prefer. `held`: by a press that was held.
  Q_INVOKABLE void apply(const QString& kind, bool held);

 signals:
  void changed();

 private:
  std::vector<std::string> robots() const;

  Control& control_;
  bool active_{false}, ready_{false};
  Point from_{}, to_{};
};

}  // namespace adit::gui

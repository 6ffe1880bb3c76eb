// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QStringList>
#include <optional>

#include "basestation/gui/scene/camera.hpp"

namespace adit::gui {

class Control;

/// Marks something on the map that the operator knows of: a place, then its kind and a text.
class MarkTool : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  /// The next tap on the map chooses the place.
  Q_PROPERTY(bool active READ active WRITE set_active NOTIFY changed)
  /// A place is chosen and waits for its kind.
  Q_PROPERTY(bool ready READ ready NOTIFY changed)
  Q_PROPERTY(QString place READ place_text NOTIFY changed)
  Q_PROPERTY(QStringList kinds READ kinds CONSTANT)

 public:
  explicit MarkTool(Control& control);

  bool active() const { return active_; }
  void set_active(bool active);
  bool ready() const { return place_.has_value(); }
  QString place_text() const;
  QStringList kinds() const;
  /// The place that is chosen, map frame, m.
  const std::optional<Point>& place() const { return place_; }
  double height() const { return z_.value_or(0.0); }  ///< m

  /// From the map: a place, map frame, m. `z`: height of the ground there, if it is known.
  void choose(const Point& place, std::optional<double> z);
  Q_INVOKABLE void drop();
  /// Stores the mark at the station. `text` may be empty.
  Q_INVOKABLE void apply(const QString& kind, const QString& text);

 signals:
  void changed();

 private:
  Control& control_;
  bool active_{false};
  std::optional<Point> place_{};
  std::optional<double> z_{};
};

}  // namespace adit::gui

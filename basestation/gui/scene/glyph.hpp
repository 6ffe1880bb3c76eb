// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QColor>
#include <QQuickPaintedItem>

namespace adit::gui {

/// A small drawing: a kind of platform (wheels, tracks, legs, rotor, unknown), a mark of a state (disc,
/// triangle, square, ring), an arrow that points up, a pie that fills, or a dashed frame.
class Glyph : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QString kind MEMBER kind_ NOTIFY changed)
  Q_PROPERTY(QColor colour MEMBER colour_ NOTIFY changed)
  Q_PROPERTY(QColor outline MEMBER outline_ NOTIFY changed)
  Q_PROPERTY(double progress MEMBER progress_ NOTIFY changed)

 public:
  explicit Glyph(QQuickItem* parent = nullptr);
  void paint(QPainter* painter) override;

 signals:
  void changed();

 private:
  QString kind_{};
  QColor colour_{Qt::white}, outline_{Qt::black};
  double progress_{1.0};
};

}  // namespace adit::gui

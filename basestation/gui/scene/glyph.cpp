// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/glyph.hpp"

#include <QPainter>
#include <QPolygonF>
#include <algorithm>

namespace adit::gui {

Glyph::Glyph(QQuickItem* parent) : QQuickPaintedItem(parent) {
  connect(this, &Glyph::changed, this, [this] { update(); });
}

void Glyph::paint(QPainter* painter) {
  if (kind_ == "frame") {
    painter->setPen(QPen(colour_, 2.0, Qt::DashLine));
    painter->drawRect(QRectF(1, 1, width() - 2, height() - 2));
    return;
  }
  const double side = std::min(width(), height());
  if (side < 2.0) return;
  painter->setRenderHint(QPainter::Antialiasing);
  painter->translate((width() - side) / 2, (height() - side) / 2);
  painter->scale(side / 20.0, side / 20.0);  // Everything below is drawn in a square of 20.
  const QPen thick(colour_, 1.8, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin);
  painter->setPen(thick);
  painter->setBrush(Qt::NoBrush);
  if (kind_ == "wheels") {
    painter->drawRoundedRect(QRectF(2, 4, 16, 7), 2, 2);
    painter->setBrush(colour_);
    for (const double x : {6.0, 14.0}) painter->drawEllipse(QPointF(x, 14), 2.6, 2.6);
  } else if (kind_ == "tracks") {
    painter->drawRoundedRect(QRectF(2, 10, 16, 7), 3.5, 3.5);
    painter->drawRect(QRectF(6, 4, 8, 5));
    for (const double x : {6.0, 10.0, 14.0}) painter->drawPoint(QPointF(x, 13.5));
  } else if (kind_ == "legs") {
    painter->drawRoundedRect(QRectF(3, 4, 14, 5), 2, 2);
    painter->drawPolyline(QPolygonF({QPointF(5, 9), QPointF(3, 13), QPointF(5, 17)}));
    painter->drawPolyline(QPolygonF({QPointF(15, 9), QPointF(13, 13), QPointF(15, 17)}));
  } else if (kind_ == "rotor") {
    painter->drawLine(QPointF(4, 4), QPointF(16, 16));
    painter->drawLine(QPointF(16, 4), QPointF(4, 16));
    for (const double x : {4.5, 15.5})
      for (const double y : {4.5, 15.5}) painter->drawEllipse(QPointF(x, y), 3.2, 3.2);
  } else if (kind_ == "unknown") {
    painter->drawEllipse(QRectF(3, 3, 14, 14));
    painter->drawPoint(QPointF(10, 10));
  } else if (kind_ == "ring") {
    painter->drawEllipse(QRectF(3.5, 3.5, 13, 13));
  } else {
    painter->setPen(QPen(outline_, 1.2));
    painter->setBrush(colour_);
    if (kind_ == "disc") painter->drawEllipse(QRectF(2.5, 2.5, 15, 15));
    if (kind_ == "square") painter->drawRect(QRectF(3, 3, 14, 14));
    if (kind_ == "triangle")
      painter->drawPolygon(QPolygonF({QPointF(10, 2), QPointF(18.5, 17.5), QPointF(1.5, 17.5)}));
    if (kind_ == "arrow")
      painter->drawPolygon(
          QPolygonF({QPointF(10, 1.5), QPointF(17, 10), QPointF(12.5, 10), QPointF(12.5, 18.5),
                     QPointF(7.5, 18.5), QPointF(7.5, 10), QPointF(3, 10)}));
    if (kind_ == "pie") {
      painter->setBrush(Qt::NoBrush);
      painter->setPen(QPen(colour_, 2.5));
      constexpr int kTop = 90 * 16, kWhole = 360 * 16;
      painter->drawArc(QRectF(2, 2, 16, 16), kTop, -static_cast<int>(kWhole * progress_));
    }
  }
}

}  // namespace adit::gui

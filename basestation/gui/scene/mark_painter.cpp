// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/mark_painter.hpp"

#include <QPainter>
#include <QPolygonF>
#include <algorithm>
#include <array>
#include <cmath>

#include "basestation/gui/scene/theme.hpp"

namespace adit::gui {

MarkPainter::MarkPainter(QQuickItem* parent) : QQuickPaintedItem(parent) {
  connect(&Theme::instance(), &Theme::changed, this, [this] { update(); });
}

void MarkPainter::show(MarkList marks, const Camera& camera, bool on_colours) {
  if (marks == marks_ && camera == camera_ && on_colours == on_colours_) return;
  marks_ = std::move(marks);
  on_colours_ = on_colours;
  camera_ = camera;
  update();
}

void MarkPainter::set_inset(double right) {
  inset_ = right;
  update();
}

void MarkPainter::draw_shape(QPainter& painter, const Shape& shape) const {
  const Theme& theme = Theme::instance();
  QPolygonF points;
  for (const Point& point : shape.points) points << QPointF(point.x, point.y);
  if (!points.boundingRect().adjusted(-1, -1, 1, 1).intersects(QRectF(0, 0, width(), height()))) return;
  painter.setOpacity(shape.opacity);
  // A filled mark has an outline of ink: in the light theme, the fills alone do not differ from the ground.
  const bool outlined = shape.filled && shape.line == Token::text;
  const auto pen_of = [&](const QColor& colour, double width) {
    QPen pen(colour, width);
    pen.setJoinStyle(Qt::RoundJoin);
    if (shape.dashed) pen.setDashPattern({7.0 / width, 5.0 / width});
    return pen;
  };
  const auto draw = [&] { shape.closed ? painter.drawPolygon(points) : painter.drawPolyline(points); };
  const bool coloured = shape.line != Token::text && shape.line != Token::dim;
  if (((theme.light() && coloured) || (on_colours_ && !outlined)) && shape.width > 0.0) {
    painter.setPen(pen_of(coloured ? theme.ink() : theme.ground(), shape.width + 2.0));
    painter.setBrush(Qt::NoBrush);
    draw();
  }
  const QPen pen = pen_of(outlined ? theme.ink() : theme.of(shape.line), std::max(shape.width, 0.1));
  painter.setPen(shape.width > 0.0 ? pen : QPen(Qt::NoPen));
  QColor fill = QColor::fromRgb(mixed(kInk, colour(shape.fill, theme.palette()), shape.shade));
  fill.setAlphaF(static_cast<float>(shape.fill_opacity));
  painter.setBrush(shape.filled ? QBrush(fill) : QBrush(Qt::NoBrush));
  draw();
}

void MarkPainter::draw_label(QPainter& painter, const MapLabel& label) const {
  const Theme& theme = Theme::instance();
  QFont font = painter.font();
  font.setPixelSize(static_cast<int>(std::lround(3.2 * theme.mm())));
  font.setBold(label.on_fill);
  painter.setFont(font);
  painter.setOpacity(label.opacity);
  const QString text = QString::fromStdString(label.text).left(40);
  QRectF box =
      painter.boundingRect(QRectF(label.at.x - 200, label.at.y - 20, 400, 40), Qt::AlignCenter, text);
  if (!box.intersects(QRectF(0, 0, width(), height()))) return;
  if (!label.on_fill) {
    QColor ground = theme.ground();
    ground.setAlphaF(0.75F);
    painter.fillRect(box.adjusted(-3, 0, 3, 0), ground);
  }
  painter.setPen(label.on_fill ? theme.ink() : theme.of(label.token));
  painter.drawText(box, Qt::AlignCenter | Qt::TextDontClip, text);
}

void MarkPainter::draw_bar(QPainter& painter) const {
  const Theme& theme = Theme::instance();
  const double length = bar_length(camera_.scale, 180.0), pixels = length * camera_.scale;
  const double right = width() - inset_ - 14, y = height() - 14;
  painter.setOpacity(1.0);
  QColor ground = theme.ground();
  ground.setAlphaF(0.75F);
  painter.fillRect(QRectF(right - pixels - 8, y - 24, pixels + 16, 32), ground);
  painter.setPen(QPen(theme.text(), 2.0));
  painter.drawLine(QPointF(right - pixels, y), QPointF(right, y));
  for (const double x : {right - pixels, right}) painter.drawLine(QPointF(x, y - 5), QPointF(x, y + 5));
  const QString text = QString::number(length) + (on_colours_ ? " m, as the grid" : " m");
  draw_label(painter, {.at = {right - pixels / 2, y - 13}, .text = text.toStdString()});
}

void MarkPainter::draw_legend(QPainter& painter) const {
  struct Entry {
    Rgb colour{};
    const char* word{};
  };
  const Theme& theme = Theme::instance();
  const Palette& palette = theme.palette();
  const std::array entries{Entry{palette.unknown, "unknown"}, Entry{palette.floor, "floor"},
                           Entry{palette.low, "low thing"}, Entry{palette.high, "wall"}};
  const double mm = theme.mm(), side = 3.0 * mm, gap = 1.2 * mm, high = 5.0 * mm;
  QFont font = painter.font();
  font.setPixelSize(static_cast<int>(std::lround(3.0 * mm)));
  painter.setFont(font);
  painter.setOpacity(1.0);
  const QFontMetricsF metrics(font);
  double wide = gap;
  for (const Entry& entry : entries) wide += side + metrics.horizontalAdvance(entry.word) + 3 * gap;
  const QRectF box(0, height() - high, wide, high);
  painter.fillRect(box, theme.panel());
  double x = 1.5 * gap;
  for (const Entry& entry : entries) {
    const QRectF swatch(x, box.center().y() - side / 2, side, side);
    painter.setPen(theme.edge());
    painter.setBrush(QColor::fromRgb(entry.colour));
    painter.drawRect(swatch);
    painter.setPen(theme.text());
    painter.drawText(QRectF(swatch.right() + gap, box.y(), wide, high), Qt::AlignLeft | Qt::AlignVCenter,
                     entry.word);
    x += side + metrics.horizontalAdvance(entry.word) + 3 * gap;
  }
}

void MarkPainter::draw_north(QPainter& painter) const {
  if (camera_.turn == 0.0) return;
  const double mm = Theme::instance().mm(), length = 4.0 * mm;
  const Point middle{8.0 * mm, 15.0 * mm}, north{-camera_.sin, -camera_.cos};  // Pixels, y down.
  const auto at = [&](double ahead, double aside) {
    return Point{middle.x + ahead * north.x - aside * north.y, middle.y + ahead * north.y + aside * north.x};
  };
  draw_shape(painter, {.points = circle(middle, 7.0 * mm),
                       .closed = true,
                       .line = Token::dim,
                       .width = 1.0,
                       .filled = true,
                       .fill = Token::none,
                       .fill_opacity = 0.0});
  draw_shape(painter, {.points = {at(length, 0), at(-length, -0.5 * length), at(-0.5 * length, 0),
                                  at(-length, 0.5 * length)},
                       .closed = true,
                       .line = Token::text,
                       .width = 1.0,
                       .filled = true,
                       .fill = Token::text});
  draw_label(painter, {.at = at(length + 2.2 * mm, 0), .text = "N"});
}

void MarkPainter::paint(QPainter* painter) {
  painter->setRenderHint(QPainter::Antialiasing);
  for (const Shape& shape : marks_.shapes) draw_shape(*painter, shape);
  for (const MapLabel& label : marks_.labels) draw_label(*painter, label);
  draw_bar(*painter);
  if (!on_colours_) draw_legend(*painter);
  draw_north(*painter);
}

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/height_legend.hpp"

#include <QPainter>
#include <cmath>

#include "basestation/gui/scene/theme.hpp"

namespace adit::gui {

void draw_height_legend(QPainter& painter, const HeightColours& colours, const QPointF& at, double mm) {
  constexpr int kTicks = 6;
  const Theme& theme = Theme::instance();
  const double title = 5.5 * mm, bar = 4.0 * mm, length = 30.0 * mm, pad = 1.5 * mm;
  QFont font = painter.font();
  font.setPixelSize(static_cast<int>(std::lround(3.2 * mm)));
  painter.setFont(font);
  QColor ground = theme.ground();
  ground.setAlphaF(0.85F);
  painter.fillRect(QRectF(at, QSizeF(19.0 * mm, title + length + 2 * pad + 2.0 * mm)), ground);
  painter.setPen(theme.text());
  painter.drawText(QRectF(at.x() + pad, at.y(), 17.0 * mm, title), Qt::AlignLeft | Qt::AlignVCenter,
                   "height, m");
  const QRectF box(at.x() + pad, at.y() + title + pad, bar, length);
  const int rows = static_cast<int>(box.height());
  for (int row = 0; row < rows; ++row) {
    const double z = colours.high() - (row + 0.5) / rows * (colours.high() - colours.low());
    painter.fillRect(QRectF(box.x(), box.y() + row, bar, 1.0), QColor::fromRgb(colours.at(z)));
  }
  for (const double z : colours.ticks(kTicks)) {
    const double y = box.bottom() - (z - colours.low()) / (colours.high() - colours.low()) * length;
    painter.drawLine(QPointF(box.right(), y), QPointF(box.right() + 1.2 * mm, y));
    painter.drawText(QRectF(box.right() + 2.0 * mm, y - 2.5 * mm, 11.0 * mm, 5.0 * mm),
                     Qt::AlignLeft | Qt::AlignVCenter, QString::number(z, 'g', 4));
  }
}

}  // namespace adit::gui

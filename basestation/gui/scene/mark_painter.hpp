// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QQuickPaintedItem>

#include "basestation/gui/scene/mark_list.hpp"

namespace adit::gui {

/// Draws a list of marks, and the scale bar.
class MarkPainter : public QQuickPaintedItem {
  Q_OBJECT

 public:
  explicit MarkPainter(QQuickItem* parent = nullptr);
  /// `camera`: for the scale bar; with a scale of 0 there is none.
  void show(MarkList marks, const Camera& camera);
  const MarkList& marks() const { return marks_; }
  void paint(QPainter* painter) override;

 private:
  void draw_shape(QPainter& painter, const Shape& shape) const;
  void draw_label(QPainter& painter, const MapLabel& label) const;
  void draw_bar(QPainter& painter) const;

  MarkList marks_{};
  Camera camera_{};
};

}  // namespace adit::gui

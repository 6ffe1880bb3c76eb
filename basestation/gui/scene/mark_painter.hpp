// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QQuickPaintedItem>

#include "basestation/gui/scene/mark_list.hpp"

namespace adit::gui {

/// Draws a list of marks, the scale bar, and where north is on a map that is turned.
class MarkPainter : public QQuickPaintedItem {
  Q_OBJECT

 public:
  explicit MarkPainter(QQuickItem* parent = nullptr);
  /// `camera`: for the scale bar. `on_colours`: the map below has colours, from which outlines set lines off,
  /// and a grid of squares as wide as the bar.
  void show(MarkList marks, const Camera& camera, bool on_colours = false);
  /// Width at the right edge where the scale bar would be covered, pixels.
  void set_inset(double right);
  const MarkList& marks() const { return marks_; }
  void paint(QPainter* painter) override;

 private:
  void draw_shape(QPainter& painter, const Shape& shape) const;
  void draw_label(QPainter& painter, const MapLabel& label) const;
  void draw_bar(QPainter& painter) const;
  /// What the colours of the map from above mean.
  void draw_legend(QPainter& painter) const;
  /// An arrow to the north, where it is not up.
  void draw_north(QPainter& painter) const;

  MarkList marks_{};
  Camera camera_{};
  bool on_colours_{false};
  double inset_{0.0};
};

}  // namespace adit::gui

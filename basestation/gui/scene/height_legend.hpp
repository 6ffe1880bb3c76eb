// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/gui/scene/height_colours.hpp"

class QPainter;
class QPointF;

namespace adit::gui {

/// Draws a bar with the colours of heights, in m, its top left corner at a point. `mm`: pixels per mm.
void draw_height_legend(QPainter& painter, const HeightColours& colours, const QPointF& at, double mm);

}  // namespace adit::gui

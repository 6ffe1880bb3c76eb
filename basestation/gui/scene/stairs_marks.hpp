// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/gui/scene/layer_marks.hpp"

namespace adit::gui {

/// Adds a staircase: a ribbon from its foot to its top with the count of its steps; from above with chevrons
/// that point uphill, from the side with the edges of its treads. It is dashed while only one robot has seen
/// it and the operator has not confirmed it. Nothing where its place cannot be drawn.
void add_stairs(const LayerScene& scene, const station::StairsItem& item, MarkList& out);

}  // namespace adit::gui

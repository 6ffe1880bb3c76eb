// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "basestation/gui/scene/colours.hpp"
#include "basestation/gui/scene/voxel_scene.hpp"

namespace adit::gui {

/// The part of the map that is shown, by height, m. What is above it would hide a floor: ceilings.
struct Slice {
  double low{-1e9}, high{1e9};
  bool operator==(const Slice&) const = default;
};

/// The colour map "turbo" (Mikhailov 2019): from dark blue over green to dark red. `share`: [0, 1].
Rgb turbo(double share);

/// The colours of heights: turbo without its darkest ends, and a little paler, so that marks stand out.
class HeightColours {
 public:
  static constexpr int kColours = 256;
  /// Ignores the lowest and highest 0.3 % of the voxels in a slice: single ones far off would take the
  /// colours from all others. Both ends are multiples of 0.2 m, so that they rarely change while a map grows.
  HeightColours(const VoxelScene& scene, const Slice& slice);
  double low() const { return low_; }  ///< Height of the first colour, m.
  double high() const { return high_; }
  Rgb at(double z) const;
  /// Heights for a legend, m: at most `most` of 1, 2 or 5 times a power of ten.
  std::vector<double> ticks(int most) const;

 private:
  double low_{0.0}, high_{1.0};
};

}  // namespace adit::gui

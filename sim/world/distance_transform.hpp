// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace adit::sim {

/// Euclidean distance from every cell of a width x height image (row by row) to the nearest cell that is not
/// 0, in cells; 1e9 when there is none. Exact: P. Felzenszwalb and D. Huttenlocher, Distance Transforms of
/// Sampled Functions (2012).
std::vector<float> distance_transform(const std::vector<std::uint8_t>& targets, int width, int height);

}  // namespace adit::sim

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::perception {

/// One output of a network: a dense tensor of floats, the last side varies fastest.
struct OutputTensor {
  std::vector<int> sides{};
  std::span<const float> values{};
};

/// A box in the picture that a network took.
struct RawBox {
  std::size_t label{};
  float score{};
  float left{}, top{}, right{}, bottom{};  ///< Pixels.
};

/// Reads the outputs of YOLO and SSD networks; see make_vision_detector(). Boxes with a score below
/// `min_score` are left out, and so are boxes without finite sides.
///
/// @param labels  Number of classes, without the background.
/// @param background  Class 0 of outputs [1, 1, boxes, 7] is the background. Of two outputs it is where there
/// is one class
///                    more than labels.
/// @param width   Of the network's picture, pixels; also `height`.
/// Error: malformed, when the outputs are of neither, or have another number of classes.
Result<std::vector<RawBox>> read_boxes(std::span<const OutputTensor> outputs, std::size_t labels,
                                       bool background, double width, double height, double min_score);

/// Keeps, of boxes of one class that overlap by more than 45 % (intersection over union), the one with the
/// highest score. At most `max` boxes, those with the highest scores first.
std::vector<RawBox> without_overlaps(std::vector<RawBox> boxes, std::size_t max);

}  // namespace adit::perception

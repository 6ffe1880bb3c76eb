// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "perception/objects/object_detector.hpp"

namespace adit::perception {

/// Makes a detector that runs on the CPU with OpenCV: the network of `params.model`, or without one OpenCV's
/// detector of upright people (histograms of oriented gradients, Dalal and Triggs 2005).
///
/// A network gets one picture [1, 3, height, width], red first, and returns one of
/// - YOLOv5: [1, boxes, 5 + classes]: middle, size, objectness and scores of the classes, in pixels;
/// - YOLOv8 and later: [1, 4 + classes, boxes];
/// - SSD: [1, 1, boxes, 7], or two outputs [1, boxes, 4] and [1, boxes, classes], the first class may be the
///   background.
///
/// Errors: cannot_read (a file), malformed (no ONNX, a network that does something else, or labels that do
/// not fit it: the text says which), missing_key (a model without labels), not_supported (this program was
/// built without OpenCV).
Result<std::shared_ptr<ObjectDetector>> make_vision_detector(const DetectorParams& params);

}  // namespace adit::perception

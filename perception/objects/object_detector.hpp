// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "perception/camera/picture.hpp"

namespace adit::perception {

/// An object in a picture: its bounding box as shares of the picture's sides, from the top left, [0, 1].
struct ObjectBox {
  std::string kind{};  ///< The class, as the detector's labels name it.
  double score{};      ///< [0, 1].
  double left{}, top{}, width{}, height{};
  double shortest{};  ///< Height of the smallest real object of this class, m; 0: unknown.
  double tallest{};   ///< Of the largest one, m; 0: unknown.
};

/// Finds objects in pictures.
class ObjectDetector {
 public:
  static constexpr std::size_t kMaxBoxes = 64;  ///< Of one picture, those with the highest scores.

  virtual ~ObjectDetector() = default;
  /// Longer sides of pictures are scaled down to this many pixels before detect().
  virtual std::uint32_t picture_side() const = 0;
  /// Takes tenths of a second of one processor: run it as compute work, one picture at a time.
  /// Errors: internal (the network cannot be evaluated), malformed (it returns numbers that are no boxes).
  virtual Result<std::vector<ObjectBox>> detect(const Picture& picture) = 0;
};

/// The detector that a robot runs.
struct DetectorParams {
  std::string model{};      ///< Path of an ONNX file; empty: the people detector of OpenCV.
  std::string labels{};     ///< Path of a text file with one class a line, in the order of the model.
  double min_score{0.5};    ///< Boxes with a lower score are ignored, [0, 1].
  double mean{0};           ///< Is subtracted from each value of a pixel, [0, 255].
  double scale{1.0 / 255};  ///< Then multiplies it. YOLO: 0 and 1/255; SSD mostly: 127 and 1/128.
  bool operator==(const DetectorParams&) const = default;
};

/// Makes a detector, which takes up to seconds. See make_vision_detector().
using DetectorFactory = std::function<Result<std::shared_ptr<ObjectDetector>>(const DetectorParams& params)>;

}  // namespace adit::perception

// SPDX-License-Identifier: Apache-2.0
#include "perception/vision/vision_detector.hpp"

namespace adit::perception {

Result<std::shared_ptr<ObjectDetector>> make_vision_detector(const DetectorParams& /*params*/) {
  return Error{Reason::not_supported,
               "this program was built without object detection: install libopencv-dnn-dev and "
               "libopencv-objdetect-dev, and build it with -DADIT_VISION=ON"};
}

}  // namespace adit::perception

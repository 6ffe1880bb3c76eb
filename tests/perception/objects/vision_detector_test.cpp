// SPDX-License-Identifier: Apache-2.0
#include "perception/vision/vision_detector.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/folders/folders.hpp"
#include "tests/perception/objects/tiny_onnx.hpp"

namespace adit::perception {
namespace {

using testing::HasSubstr;

class VisionDetector : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    const std::string path = folder_ + "/" + name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  DetectorParams tiny(const std::string& labels = "person\n") const {
    return {.model = write("tiny.onnx", tiny_onnx::model()), .labels = write("labels.txt", labels)};
  }
  std::string folder_{scratch_folder()};
};

/// Grey, with a blue area of 24 x 32 pixels.
Picture picture_with(std::uint32_t left, std::uint32_t top) {
  Picture out{.width = 320, .height = 240, .channels = 3};
  out.bytes.assign(std::size_t{3} * 320 * 240, 128);
  for (std::uint32_t y = top; y < top + 32; ++y)
    for (std::uint32_t x = left; x < left + 24; ++x) {
      std::uint8_t* pixel = &out.bytes[3 * (std::size_t{y} * 320 + x)];
      pixel[0] = 20;
      pixel[1] = 60;
      pixel[2] = 220;
    }
  return out;
}

TEST_F(VisionDetector, ATinyNetworkFindsItsObject) {
  const auto detector = make_vision_detector(tiny());
  ASSERT_TRUE(detector) << detector.error().text;
  EXPECT_EQ((*detector)->picture_side(), 320U);
  const auto boxes = (*detector)->detect(picture_with(200, 80));
  ASSERT_TRUE(boxes) << boxes.error().text;
  ASSERT_EQ(boxes->size(), 1U);
  const ObjectBox& box = boxes->front();
  EXPECT_EQ(box.kind, "person");
  EXPECT_GT(box.score, 0.6);
  EXPECT_NEAR(box.left, 200.0 / 320, 0.02);
  EXPECT_NEAR(box.top, 80.0 / 240, 0.02);
  EXPECT_NEAR(box.width, 24.0 / 320, 0.005);
  EXPECT_NEAR(box.height, 32.0 / 240, 0.005);
}

TEST_F(VisionDetector, NothingWhereThereIsNothing) {
  const auto detector = make_vision_detector(tiny()).value();
  Picture grey{.width = 100, .height = 400, .channels = 1};
  grey.bytes.assign(std::size_t{100} * 400, 90);
  EXPECT_TRUE(detector->detect(grey)->empty());
  EXPECT_EQ(detector->detect({}).reason(), Reason::internal);
}

TEST_F(VisionDetector, RefusesBadFilesByName) {
  DetectorParams params = tiny();
  params.model = write("classes.onnx", tiny_onnx::model(false));
  EXPECT_THAT(make_vision_detector(params).error().text, HasSubstr("neither boxes of a YOLO nor"));
  params.model = write("text.onnx", "this is no network");
  EXPECT_THAT(make_vision_detector(params).error().text, HasSubstr("no ONNX model"));
  params.model = write("cut.onnx", tiny_onnx::model().substr(0, 5000));
  EXPECT_EQ(make_vision_detector(params).reason(), Reason::malformed);
  params.model = write("empty.onnx", "");
  EXPECT_EQ(make_vision_detector(params).reason(), Reason::cannot_read);
  params.model = folder_ + "/missing.onnx";
  EXPECT_EQ(make_vision_detector(params).reason(), Reason::cannot_read);
  params = tiny("person\nrope\nvent\n");
  EXPECT_THAT(make_vision_detector(params).error().text, HasSubstr("3 classes"));
  EXPECT_THAT(make_vision_detector(tiny("")).error().text, HasSubstr("one class a line"));
  EXPECT_THAT(make_vision_detector(tiny("person\n\nrope\n")).error().text, HasSubstr("empty lines"));
  params = tiny();
  params.labels.clear();
  EXPECT_EQ(make_vision_detector(params).reason(), Reason::missing_key);
}

TEST_F(VisionDetector, AnUnknownOperationIsRefused) {
  std::string bytes = tiny_onnx::model();
  for (std::size_t at = bytes.find("Relu"); at != std::string::npos; at = bytes.find("Relu")) bytes[at] = 'X';
  DetectorParams params = tiny();
  params.model = write("unknown.onnx", bytes);
  EXPECT_THAT(make_vision_detector(params).error().text, HasSubstr("OpenCV: "));
}

TEST_F(VisionDetector, WithoutAModelItSeeksPeople) {
  const auto detector = make_vision_detector({});
  ASSERT_TRUE(detector) << detector.error().text;
  EXPECT_TRUE((*detector)->detect(picture_with(100, 100))->empty());
  const Picture narrow{.width = 20, .height = 200, .channels = 1, .bytes = std::vector<std::uint8_t>(4000)};
  EXPECT_TRUE((*detector)->detect(narrow)->empty());
}

}  // namespace
}  // namespace adit::perception

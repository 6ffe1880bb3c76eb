// SPDX-License-Identifier: Apache-2.0
#include "perception/vision/box_outputs.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace adit::perception {
namespace {

using testing::HasSubstr;

Result<std::vector<RawBox>> read(const std::vector<OutputTensor>& outputs, std::size_t labels = 2,
                                 bool background = false) {
  return read_boxes(outputs, labels, background, 100, 50, 0.5);
}

void expect_box(const Result<std::vector<RawBox>>& boxes, std::size_t label, float score) {
  ASSERT_TRUE(boxes) << boxes.error().text;
  ASSERT_EQ(boxes->size(), 1U);
  const RawBox& box = boxes->front();
  EXPECT_EQ(box.label, label);
  EXPECT_FLOAT_EQ(box.score, score);
  EXPECT_FLOAT_EQ(box.left, 10);
  EXPECT_FLOAT_EQ(box.top, 20);
  EXPECT_FLOAT_EQ(box.right, 30);
  EXPECT_FLOAT_EQ(box.bottom, 40);
}

TEST(BoxOutputs, ReadsYolo5) {
  // Two boxes; the second one has no object in it.
  const std::vector<float> values{20, 30, 20, 20, 0.9F, 0.1F, 1.0F, 20, 30, 20, 20, 0.1F, 1, 1};
  expect_box(read({{{1, 2, 7}, values}}), 1, 0.9F);
}

TEST(BoxOutputs, ReadsYolo8) {
  const std::vector<float> values{20, 5, 30, 5, 20, 2, 20, 2, 0.2F, 0.1F, 0.8F, 0.4F};
  expect_box(read({{{1, 6, 2}, values}}), 1, 0.8F);
}

TEST(BoxOutputs, ReadsSsd) {
  const std::vector<float> values{0, 1, 0.7F, 0.1F, 0.4F, 0.3F, 0.8F, 0, 9, 0.9F, 0,
                                  0, 1, 1,    -1,   0,    0,    0,    0, 0, 0};
  expect_box(read({{{1, 1, 3, 7}, values}}), 1, 0.7F);
}

TEST(BoxOutputs, TheFirstClassOfSsdMayBeTheBackground) {
  const std::vector<float> values{0, 0, 0.9F, 0, 0, 1, 1, 0, 2, 0.7F, 0.1F, 0.4F, 0.3F, 0.8F};
  expect_box(read({{{1, 1, 2, 7}, values}}, 2, true), 1, 0.7F);
}

TEST(BoxOutputs, ReadsSsdWithTwoOutputsInAnyOrder) {
  const std::vector<float> corners{0.1F, 0.4F, 0.3F, 0.8F}, scores{0.9F, 0.05F, 0.6F};  // Background first.
  expect_box(read({{{1, 1, 4}, corners}, {{1, 1, 3}, scores}}), 1, 0.6F);
  expect_box(read({{{1, 1, 3}, scores}, {{1, 1, 4}, corners}}), 1, 0.6F);
}

TEST(BoxOutputs, RefusesOtherShapesByName) {
  const std::vector<float> values(1000);
  const auto classes = read({{{1, 1000}, values}});
  EXPECT_EQ(classes.reason(), Reason::malformed);
  EXPECT_THAT(classes.error().text, HasSubstr("[1, 1000]"));
  EXPECT_THAT(read({{{1, 10, 85}, std::vector<float>(850)}}).error().text, HasSubstr("2 classes"));
  EXPECT_EQ(read({}).reason(), Reason::malformed);
  EXPECT_EQ(read({{{1, 2, 7}, std::span(values).first(3)}}).reason(), Reason::malformed);  // Truncated.
  EXPECT_EQ(read({{{1, 0, 7}, {}}}).reason(), Reason::malformed);
  EXPECT_EQ(read({{{1, -2, -7}, std::span(values).first(14)}}).reason(), Reason::malformed);
  EXPECT_EQ(read({{{1, 2, 7}, std::span(values).first(14)}}, 0).reason(), Reason::malformed);
}

TEST(BoxOutputs, NumbersThatAreNoBoxesAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf, -kInf}) {
    const std::vector<float> values{bad, 30, 20, 20, 1, 1, 0};
    EXPECT_TRUE(read({{{1, 1, 7}, values}})->empty());
  }
  EXPECT_TRUE(read({{{1, 1, 7}, std::vector<float>{20, 30, 20, 20, kNan, 1, 0}}})->empty());
  EXPECT_TRUE(read({{{1, 1, 7}, std::vector<float>{20, 30, -5, 20, 1, 1, 0}}})->empty());
  const std::vector<float> label{0, kNan, 0.7F, 0.1F, 0.4F, 0.3F, 0.8F};
  EXPECT_TRUE(read({{{1, 1, 1, 7}, label}})->empty());
}

TEST(BoxOutputs, OneBoxForEachObject) {
  const RawBox best{0, 0.9F, 0, 0, 20, 20}, same{0, 0.8F, 2, 0, 22, 20}, other{1, 0.7F, 0, 0, 20, 20},
      apart{0, 0.6F, 40, 0, 60, 20};
  const auto kept = without_overlaps({same, apart, best, other}, 9);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].score, 0.9F);
  EXPECT_EQ(kept[1].label, 1U);
  EXPECT_EQ(kept[2].left, 40.0F);
  EXPECT_EQ(without_overlaps({same, apart, best, other}, 1).size(), 1U);
}

}  // namespace
}  // namespace adit::perception

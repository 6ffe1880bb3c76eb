// SPDX-License-Identifier: Apache-2.0
#include "perception/vision/onnx_input.hpp"

#include <gmock/gmock.h>

#include <random>

#include "tests/perception/objects/tiny_onnx.hpp"

namespace adit::perception {
namespace {

using tiny_onnx::Message, tiny_onnx::value_info;

Result<OnnxInput> read(const std::string& model) {
  return read_onnx_input({reinterpret_cast<const std::uint8_t*>(model.data()), model.size()});
}
std::string with_inputs(const std::vector<Message>& inputs, const std::vector<Message>& weights = {}) {
  Message graph;
  for (const Message& weight : weights) graph.message(5, weight);
  for (const Message& input : inputs) graph.message(11, input);
  return Message().number(1, 7).message(7, graph).bytes();
}

TEST(OnnxInput, ReadsTheSizeOfThePicture) {
  const auto input = read(tiny_onnx::model());
  ASSERT_TRUE(input) << input.error().text;
  EXPECT_EQ(input->width, 320U);
  EXPECT_EQ(input->height, 320U);
  const auto wide = read(with_inputs({value_info("images", {1, 3, 240, 416})}));
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->width, 416U);
  EXPECT_EQ(wide->height, 240U);
}

TEST(OnnxInput, SkipsWeightsAmongTheInputs) {
  const auto input = read(with_inputs({value_info("w", {9, 3, 3, 3}), value_info("images", {1, 3, 64, 64})},
                                      {tiny_onnx::floats("w", {1}, {0.0F})}));
  ASSERT_TRUE(input) << input.error().text;
  EXPECT_EQ(input->width, 64U);
}

TEST(OnnxInput, OpenSidesAre640) {
  const Message open = Message().text(2, "height");  // dim_param
  Message shape;
  shape.message(1, Message().number(1, 1))
      .message(1, Message().number(1, 3))
      .message(1, open)
      .message(1, open);
  const Message type = Message().message(1, Message().number(1, 1).message(2, shape));
  const auto input = read(with_inputs({Message().text(1, "images").message(2, type)}));
  ASSERT_TRUE(input) << input.error().text;
  EXPECT_EQ(input->height, 640U);
}

TEST(OnnxInput, SidesOfMinusOneAreOpen) {
  const auto open = static_cast<std::uint64_t>(-1);
  const auto input = read(with_inputs({value_info("images", {open, 3, open, 416})}));
  ASSERT_TRUE(input) << input.error().text;
  EXPECT_EQ(input->height, 640U);
  EXPECT_EQ(input->width, 416U);
}

TEST(OnnxInput, RefusesWhatIsNoPicture) {
  EXPECT_THAT(read(with_inputs({value_info("text", {1, 128})})).error().text, testing::HasSubstr("[1, 128]"));
  EXPECT_EQ(read(with_inputs({value_info("images", {8, 3, 64, 64})})).reason(), Reason::malformed);
  EXPECT_EQ(read(with_inputs({value_info("images", {1, 3, 9000, 64})})).reason(), Reason::out_of_range);
  EXPECT_EQ(read(with_inputs({value_info("images", {1, 3, 4, 64})})).reason(), Reason::out_of_range);
  for (const char* bytes : {"", "no model", "\x3a\x7f", "\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff"})
    EXPECT_EQ(read(bytes).reason(), Reason::malformed) << bytes;
}

TEST(OnnxInput, SurvivesDamageAnywhere) {
  const std::string good = tiny_onnx::model(false);
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string bad = good;
    for (int j = 0; j < 4; ++j) bad[random() % bad.size()] = static_cast<char>(random());
    if (i % 3 == 0) bad.resize(random() % bad.size());
    const auto read_back = read(bad);
    EXPECT_LE(read_back ? read_back->width : 0U, 2048U);
  }
}

}  // namespace
}  // namespace adit::perception

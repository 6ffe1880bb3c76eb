// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

/// A small network in ONNX, made by hand: it finds blue areas of about 24 x 32 pixels, as the jackets of
/// simulated people.
namespace adit::tiny_onnx {

/// Appends the fields of a protobuf message.
class Message {
 public:
  Message& number(std::uint32_t field, std::uint64_t value) {
    varint(std::uint64_t{field} << 3);
    varint(value);
    return *this;
  }
  Message& text(std::uint32_t field, const std::string& value) {
    varint(std::uint64_t{field} << 3 | 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  Message& message(std::uint32_t field, const Message& value) { return text(field, value.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }
  std::string bytes_{};
};

inline constexpr int kSide = 320, kWide = 24, kHigh = 32, kStep = 8;
inline constexpr int kColumns = (kSide - kWide) / kStep + 1, kRows = (kSide - kHigh) / kStep + 1;

template <class T>
Message tensor(const std::string& name, const std::vector<std::uint64_t>& sides, std::uint64_t type,
               const std::vector<T>& values) {
  Message out;
  for (const std::uint64_t side : sides) out.number(1, side);
  std::string raw(values.size() * sizeof(T), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return out.number(2, type).text(8, name).text(9, raw);
}
inline Message floats(const std::string& name, const std::vector<std::uint64_t>& sides,
                      const std::vector<float>& values) {
  return tensor(name, sides, 1, values);
}
inline Message integers(const std::string& name, const std::vector<std::int64_t>& values) {
  return tensor(name, {values.size()}, 7, values);
}

inline Message value_info(const std::string& name, const std::vector<std::uint64_t>& sides) {
  Message shape;
  for (const std::uint64_t side : sides) shape.message(1, Message().number(1, side));
  const Message type = Message().number(1, 1).message(2, shape);
  return Message().text(1, name).message(2, Message().message(1, type));
}

inline Message node(const std::string& type, const std::vector<std::string>& inputs,
                    const std::string& output, const std::vector<Message>& attributes = {}) {
  Message out;
  for (const std::string& input : inputs) out.text(1, input);
  out.text(2, output).text(3, output).text(4, type);
  for (const Message& attribute : attributes) out.message(5, attribute);
  return out;
}
inline Message attribute(const std::string& name, const std::vector<std::uint64_t>& values) {
  Message out = Message().text(1, name);
  for (const std::uint64_t value : values) out.number(8, value);
  return out.number(20, 7);
}
inline Message attribute(const std::string& name, std::uint64_t value) {
  return Message().text(1, name).number(3, value).number(20, 2);
}

/// The network: [1, 3, 320, 320] to [1, 5, boxes], as YOLOv8 with one class. `boxes` false: it returns the
/// scores alone, and is no detector.
inline std::string model(bool boxes = true) {
  // The mean of blue less half of red and green: a blue jacket has 0.7 in full light.
  std::vector<float> weights(std::size_t{3} * kWide * kHigh);
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = (i / (std::size_t{kWide} * kHigh) == 2 ? 1.0F : -0.5F) / (kWide * kHigh);
  const std::size_t cells = std::size_t{kColumns} * kRows;
  std::vector<float> places(4 * cells);
  for (std::size_t i = 0; i < cells; ++i) {
    places[i] = static_cast<float>(i % kColumns * kStep) + kWide / 2.0F;
    places[cells + i] = static_cast<float>(i / kColumns * kStep) + kHigh / 2.0F;
    places[2 * cells + i] = kWide;
    places[3 * cells + i] = kHigh;
  }
  Message graph;
  graph.message(1, node("Conv", {"images", "weights"}, "sum",
                        {attribute("strides", {kStep, kStep}), attribute("kernel_shape", {kHigh, kWide})}));
  graph.message(1, node("Relu", {"sum"}, "scores"));
  if (boxes) {
    graph.message(1, node("Concat", {"places", "scores"}, "grid", {attribute("axis", 1)}));
    graph.message(1, node("Reshape", {"grid", "shape"}, "output"));
  }
  graph.text(2, "tiny");
  graph.message(5, floats("weights", {1, 3, kHigh, kWide}, weights));
  if (boxes) {
    graph.message(5, floats("places", {1, 4, kRows, kColumns}, places));
    graph.message(5, integers("shape", {1, 5, static_cast<std::int64_t>(cells)}));
  }
  graph.message(11, value_info("images", {1, 3, kSide, kSide}));
  graph.message(12,
                boxes ? value_info("output", {1, 5, cells}) : value_info("scores", {1, 1, kRows, kColumns}));
  return Message().number(1, 7).message(7, graph).message(8, Message().text(1, "").number(2, 12)).bytes();
}

}  // namespace adit::tiny_onnx

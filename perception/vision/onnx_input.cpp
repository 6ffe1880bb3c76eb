// SPDX-License-Identifier: Apache-2.0
#include "perception/vision/onnx_input.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace adit::perception {
namespace {

constexpr std::uint32_t kUsualSide = 640, kMinSide = 16, kMaxSide = 2048;

using Bytes = std::span<const std::uint8_t>;

/// A field of a protobuf message.
struct Field {
  std::uint32_t number{};
  std::uint64_t value{};  ///< Of a varint.
  Bytes bytes{};          ///< Of a string, a message or packed numbers.
};

/// Reads the fields of a protobuf message one after the other.
class FieldReader {
 public:
  explicit FieldReader(Bytes bytes) : rest_(bytes) {}

  /// Nothing at the end, and at damage.
  std::optional<Field> next() {
    if (rest_.empty()) return std::nullopt;
    const auto key = varint();
    if (!key) return fail();
    Field out{.number = static_cast<std::uint32_t>(*key >> 3)};
    switch (*key & 7) {
      case 0: {
        const auto value = varint();
        if (!value) return fail();
        out.value = *value;
        return out;
      }
      case 1:
        return skip(8) ? std::optional(out) : fail();
      case 2: {
        const auto size = varint();
        if (!size || *size > rest_.size()) return fail();
        out.bytes = rest_.first(static_cast<std::size_t>(*size));
        rest_ = rest_.subspan(out.bytes.size());
        return out;
      }
      case 5:
        return skip(4) ? std::optional(out) : fail();
      default:
        return fail();
    }
  }
  bool damaged() const { return damaged_; }

 private:
  std::optional<Field> fail() {
    damaged_ = true;
    rest_ = {};
    return std::nullopt;
  }
  bool skip(std::size_t bytes) {
    if (rest_.size() < bytes) return false;
    rest_ = rest_.subspan(bytes);
    return true;
  }
  std::optional<std::uint64_t> varint() {
    std::uint64_t out = 0;
    for (unsigned shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const std::uint8_t byte = rest_.front();
      rest_ = rest_.subspan(1);
      out |= std::uint64_t{byte & 0x7fU} << shift;
      if ((byte & 0x80U) == 0) return out;
    }
    return std::nullopt;
  }

  Bytes rest_;
  bool damaged_{false};
};

/// All fields of that number; damage behind them is ignored.
std::vector<Field> fields(Bytes message, std::uint32_t number) {
  std::vector<Field> out;
  FieldReader reader(message);
  while (const auto field = reader.next())
    if (field->number == number) out.push_back(*field);
  return out;
}

Bytes first(Bytes message, std::uint32_t number) {
  const auto all = fields(message, number);
  return all.empty() ? Bytes{} : all.front().bytes;
}

std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

Result<OnnxInput> read_onnx_input(Bytes model) {
  constexpr std::uint32_t kGraph = 7, kInitializer = 5, kInput = 11, kTensorName = 8, kValueName = 1;
  const Error no_model{Reason::malformed, "it is no ONNX model"};
  FieldReader reader(model);
  Bytes graph;
  while (const auto field = reader.next())
    if (field->number == kGraph) graph = field->bytes;
  if (reader.damaged() || graph.empty()) return no_model;
  std::set<std::string> weights;
  for (const Field& each : fields(graph, kInitializer))
    weights.insert(text_of(first(each.bytes, kTensorName)));
  for (const Field& input : fields(graph, kInput)) {
    if (weights.contains(text_of(first(input.bytes, kValueName)))) continue;
    // ValueInfoProto.type.tensor_type.shape.dim, each with dim_value.
    std::vector<std::uint64_t> sides;
    for (const Field& side : fields(first(first(first(input.bytes, 2), 1), 2), 1)) {
      const auto values = fields(side.bytes, 1);
      // Some exporters write an open side as -1.
      const bool open = values.empty() || values.front().value >> 63 != 0;
      sides.push_back(open ? 0 : values.front().value);
    }
    if (sides.size() != 4 || sides[0] > 1 || sides[1] != 3) {
      std::string shape;
      for (const std::uint64_t side : sides) shape += (shape.empty() ? "" : ", ") + std::to_string(side);
      return Error{Reason::malformed,
                   "its input is [" + shape + "], not a picture [1, 3, height, width] of three colours"};
    }
    const auto side = [](std::uint64_t given) { return given == 0 ? kUsualSide : given; };
    const std::uint64_t height = side(sides[2]), width = side(sides[3]);
    if (std::min(width, height) < kMinSide || std::max(width, height) > kMaxSide)
      return Error{Reason::out_of_range, "it takes pictures of " + std::to_string(width) + "x" +
                                             std::to_string(height) +
                                             " pixels: expected sides of 16 to 2048"};
    return OnnxInput{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  }
  return no_model;
}

}  // namespace adit::perception

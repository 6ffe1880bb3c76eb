// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "core/result/result.hpp"

namespace adit::perception {

/// Size of the picture that a network takes, pixels.
struct OnnxInput {
  std::uint32_t width{}, height{};
};

/// Reads the shape of the first input of an ONNX model that is no weight: [1, 3, height, width]. Sizes that
/// the model leaves open are 640. Source: onnx.proto3 (ONNX 1.12).
///
/// Errors: malformed (no ONNX model, or an input of another shape, which the text gives), out_of_range (a
/// side of less than 16 or more than 2048 pixels).
Result<OnnxInput> read_onnx_input(std::span<const std::uint8_t> model);

}  // namespace adit::perception

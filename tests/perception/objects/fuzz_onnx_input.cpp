// SPDX-License-Identifier: Apache-2.0
// Files that are given as an ONNX model, as libFuzzer makes them up. Built by tools/fuzz.sh.
#include <cstdlib>

#include "perception/vision/onnx_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto input = adit::perception::read_onnx_input({data, size});
  if (input && (input->width < 16 || input->width > 2048 || input->height < 16 || input->height > 2048))
    std::abort();
  return 0;
}

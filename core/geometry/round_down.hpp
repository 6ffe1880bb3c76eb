// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>

namespace adit {

/// The largest integer that is not above a number, which must fit an int. For inner loops: std::floor is a
/// function call without SSE 4.1.
template <std::floating_point T>
int round_down(T value) {
  const int i = static_cast<int>(value);
  return i - (value < static_cast<T>(i));
}

}  // namespace adit

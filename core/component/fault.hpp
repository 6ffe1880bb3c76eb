// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit {

/// Fault that a test injects into a component, on the component's own strand.
enum class ComponentFault : std::uint8_t {
  crash,  ///< A callback throws.
  hang,   ///< A callback does not return.
};

}  // namespace adit

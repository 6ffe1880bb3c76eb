#pragma once
#include <cstdint>

namespace adit {

/// What a test does to a component on purpose, on the component's own strand.
enum class ComponentFault : std::uint8_t {
  crash,  ///< a callback throws
  hang,   ///< a callback does not return
};

}  // namespace adit

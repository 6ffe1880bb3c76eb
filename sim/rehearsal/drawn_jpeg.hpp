// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/store/disk.hpp"

namespace adit::sim {

/// Draws a JPEG of noise with about that many bytes: within 10 % from 5 kB on. The same seed draws the same
/// one.
store::Bytes drawn_jpeg(std::size_t bytes, std::uint64_t seed);

}  // namespace adit::sim

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "perception/camera/picture.hpp"

namespace adit::perception {

/// A baseline JPEG with the standard tables and a restart marker after each `span` MCUs (8 x 8 pixels when
/// grey, else 16 x 16). Empty when the size and the bytes of the picture do not fit, or have a side of 0.
std::vector<std::uint8_t> write_striped_jpeg(const Picture& picture, int quality, std::uint32_t span);

/// A JPEG, cut at its restart markers. Views into it.
struct StripedJpeg {
  std::span<const std::uint8_t> header{};  ///< From its start to the entropy-coded data.
  std::vector<std::span<const std::uint8_t>> stripes{};
};
/// Cuts what write_striped_jpeg() made.
StripedJpeg cut_at_markers(std::span<const std::uint8_t> jpeg);

}  // namespace adit::perception

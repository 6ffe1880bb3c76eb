#include "nav/ray_image.hpp"

#include <algorithm>

namespace adit::nav {

RayImage::RayImage() : bins_(kColumns * kRows, kEmpty) {}

void RayImage::clear() {
  std::fill(bins_.begin(), bins_.end(), kEmpty);
  lowest_ = 0.0f;
}

bool RayImage::saw_through(float dx, float dy, float z_low, float z_high, float range, float beyond) const {
  const int column = column_of(dx, dy);
  const int first = std::max(0, row_of(z_low / range));
  const int last = std::min(kRows - 1, row_of(z_high / range));
  const auto need = static_cast<std::uint16_t>(std::min(60000.0f, (range + beyond) * 100.0f));
  for (int row = first; row <= last; ++row) {
    const std::uint16_t bin = bins_[row * kColumns + column];
    if (bin != kEmpty && bin > need) return true;
  }
  return false;
}

}  // namespace adit::nav

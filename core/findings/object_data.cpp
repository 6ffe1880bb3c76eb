// SPDX-License-Identifier: Apache-2.0
#include "core/findings/object_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace adit::findings {
namespace {

constexpr std::array<std::uint8_t, 5> kObjectTag{'O', 'B', 'J', 'T', 1};
constexpr std::size_t kSize = kObjectTag.size() + 3;
constexpr double kMaxCentimetres = 65535.0, kMaxScore = 255.0;

}  // namespace

store::Bytes encode_object(const ObjectData& object) {
  const auto sigma =
      static_cast<std::uint16_t>(std::clamp(std::round(object.sigma * 100.0), 1.0, kMaxCentimetres));
  const auto score =
      static_cast<std::uint8_t>(std::clamp(std::round(object.score * kMaxScore), 0.0, kMaxScore));
  store::Bytes out(kObjectTag.begin(), kObjectTag.end());
  out.push_back(static_cast<std::uint8_t>(sigma & 0xff));
  out.push_back(static_cast<std::uint8_t>(sigma >> 8));
  out.push_back(score);
  return out;
}

std::optional<ObjectData> read_object(const Finding& finding) {
  const store::Bytes& data = finding.data;
  if (data.size() != kSize || !std::equal(kObjectTag.begin(), kObjectTag.end(), data.begin()))
    return std::nullopt;
  const unsigned sigma = data[5] | static_cast<unsigned>(data[6]) << 8;
  if (sigma == 0) return std::nullopt;
  return ObjectData{sigma / 100.0, data[7] / kMaxScore};
}

}  // namespace adit::findings

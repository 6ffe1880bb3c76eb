// SPDX-License-Identifier: Apache-2.0
#include "core/findings/mark_data.hpp"

#include <algorithm>

namespace adit::findings {
namespace {

constexpr std::array<std::uint8_t, 5> kMarkTag{'M', 'A', 'R', 'K', 1};

}  // namespace

store::Bytes encode_mark(const StationId& station) {
  store::Bytes out(kMarkTag.begin(), kMarkTag.end());
  out.insert(out.end(), station.begin(), station.end());
  return out;
}

std::optional<StationId> marked_by(const Finding& finding) {
  StationId station{};
  const store::Bytes& data = finding.data;
  if (data.size() != kMarkTag.size() + station.size() ||
      !std::equal(kMarkTag.begin(), kMarkTag.end(), data.begin()))
    return std::nullopt;
  std::copy(data.begin() + kMarkTag.size(), data.end(), station.begin());
  return station;
}

std::uint8_t usual_importance(std::string_view kind) {
  constexpr std::uint8_t kLife = 9, kDanger = 7, kOther = 5;
  if (kind == "person" || kind == "fire") return kLife;
  return kind == "gas" || kind == "hazard" ? kDanger : kOther;
}

}  // namespace adit::findings

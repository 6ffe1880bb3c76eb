// SPDX-License-Identifier: Apache-2.0
#include "core/findings/mark_data.hpp"

#include <algorithm>
#include <array>

namespace adit::findings {
namespace {

constexpr std::array<std::uint8_t, 5> kMarkTag{'M', 'A', 'R', 'K', 1};

}  // namespace

store::Bytes encode_mark() { return {kMarkTag.begin(), kMarkTag.end()}; }

std::optional<Owner> marked_by(const Finding& finding) {
  if (!std::ranges::equal(finding.data, kMarkTag) || finding.key.owner == Owner{}) return std::nullopt;
  return finding.key.owner;
}

std::uint8_t usual_importance(std::string_view kind) {
  constexpr std::uint8_t kLife = 9, kDanger = 7, kOther = 5;
  if (kind == "person" || kind == "fire") return kLife;
  return kind == "gas" || kind == "hazard" ? kDanger : kOther;
}

}  // namespace adit::findings

// SPDX-License-Identifier: Apache-2.0
#include "core/contract/refusals.hpp"

namespace adit::contract {

std::string describe(const wire::RefusalCounts& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    if (!text.empty()) text += ", ";
    text += wire::to_string(static_cast<wire::Refusal>(i));
    text += ' ' + std::to_string(counts[i]);
  }
  return text;
}

std::string RefusalNews::told(const wire::RefusalCounts& counts, Time now) {
  wire::RefusalCounts news{};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    Kind& kind = kinds_[i];
    if (counts[i] <= kind.count) continue;
    if (kind.count == 0 || now - kind.seen > kQuiet) news[i] = counts[i] - kind.count;
    kind = {counts[i], now};
  }
  return describe(news);
}

}  // namespace adit::contract

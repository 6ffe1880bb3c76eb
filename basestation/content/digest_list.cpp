// SPDX-License-Identifier: Apache-2.0
#include "basestation/content/digest_list.hpp"

#include <algorithm>

namespace adit::station {
namespace {

constexpr std::size_t kFewReceipts = 6;  // With more, an acknowledgement has room for one digest.

static_assert(transfer::ContentDigest::kParts == perception::MapDigest::kParts);

}  // namespace

std::optional<DigestList::Digests> DigestList::due(const ChunkStore& chunks, std::size_t receipts,
                                                   double bandwidth, Time now) {
  if (sent_ && now - *sent_ < kPeriod) return std::nullopt;
  sent_ = now;
  const bool thin = bandwidth > 0.0 && bandwidth < kThin;
  const std::size_t count =
      std::min(chunks.robots().size(), thin || receipts > kFewReceipts ? 1 : kMaxDigests);
  Digests out;
  out.all = count == chunks.robots().size();
  for (auto at = chunks.robots().upper_bound(last_); out.list.size() < count; ++at) {
    if (at == chunks.robots().end()) at = chunks.robots().begin();
    out.list.push_back({at->first, at->second.digest.sums});
    last_ = at->first;
  }
  return out;
}

}  // namespace adit::station

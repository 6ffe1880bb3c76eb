// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/counted_source.hpp"

#include "perception/stream/piece.hpp"

namespace adit::bench {

std::optional<transfer::Source::Content> CountedSource::next(std::span<const transfer::PeerId> peers,
                                                             std::size_t max_bytes, Time now) {
  ++asked_;
  auto content = source_.next(peers, max_bytes, now);
  if (!content) return content;
  const auto piece = perception::decode(content->data, find_stored_);
  if (!piece) return content;
  account_.content += content->data.size();
  ++account_.sent;
  const double part = static_cast<double>(content->data.size()) / static_cast<double>(piece->blocks.size());
  std::vector<Name>& names = flights_[content->token];
  for (const perception::BlockUpdate& update : piece->blocks) {
    if (update.coarse) {
      account_.coarse += part;
      continue;
    }
    const Name& name = names.emplace_back(piece->key.index, update.block.index);
    const bool repeated = lost_.erase(name) != 0;
    const bool first = ever_.insert(name).second;
    (repeated ? account_.repeated : first ? account_.first : account_.changed) += part;
  }
  return content;
}

void CountedSource::acknowledged(const transfer::PeerId& peer, std::uint64_t token) {
  source_.acknowledged(peer, token);
}

void CountedSource::lost(const transfer::PeerId& peer, std::uint64_t token) {
  ++account_.lost;
  if (const auto flight = flights_.find(token); flight != flights_.end())
    lost_.insert(flight->second.begin(), flight->second.end());
  source_.lost(peer, token);
}

void CountedSource::settled(std::uint64_t token) {
  flights_.erase(token);
  source_.settled(token);
}

}  // namespace adit::bench

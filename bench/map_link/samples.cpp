// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/samples.hpp"

#include <algorithm>

#include "perception/stream/block_walk.hpp"

namespace adit::bench {

void SampleCollector::add(const perception::BlockSet& set, std::uint32_t weight,
                          const perception::FindBase& find_base) {
  weight_ = weight;
  with_base_only_ = static_cast<bool>(find_base);
  perception::BlockWalk(*this, set.level, find_base).write(set);
}

bool SampleCollector::decide(int decision, const perception::VoxelContext& context, bool value) {
  if (with_base_only_ && decision < perception::kDecisionsAlone) return value;
  Answers answers{};
  for (int feature = 0; feature < perception::feature_count(); ++feature)
    if (context.test(feature))
      answers[static_cast<std::size_t>(feature) / 64] |= std::uint64_t{1} << (feature % 64);
  counts_[static_cast<std::size_t>(decision)][answers][value ? 1 : 0] += weight_;
  return value;
}

std::vector<Sample> SampleCollector::samples(int decision) const {
  std::vector<Sample> out;
  for (const auto& [answers, count] : counts_[static_cast<std::size_t>(decision)])
    out.push_back({answers, count});
  // The same samples give the same trees whatever the order in the table is.
  std::sort(out.begin(), out.end(), [](const Sample& a, const Sample& b) { return a.answers < b.answers; });
  return out;
}

std::vector<perception::BlockSet> sets_of(std::vector<perception::FineBlock> blocks, int level,
                                          std::size_t blocks_in_set) {
  std::sort(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
  std::vector<perception::BlockSet> out;
  for (std::size_t at = 0; at < blocks.size(); at += blocks_in_set) {
    const std::size_t count = std::min(blocks_in_set, blocks.size() - at);
    perception::BlockSet set = perception::block_set(std::span(blocks).subspan(at, count));
    while (set.level > level) set = perception::coarser(set);
    out.push_back(std::move(set));
  }
  return out;
}

}  // namespace adit::bench

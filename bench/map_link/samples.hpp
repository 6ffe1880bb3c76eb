// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "perception/stream/block_coder.hpp"
#include "perception/stream/block_context.hpp"

namespace adit::bench {

/// Answers to all questions about the surroundings of one decision.
using Answers = std::array<std::uint64_t, 4>;

struct AnswersHash {
  std::size_t operator()(const Answers& a) const {
    std::uint64_t h = 0;
    for (const std::uint64_t part : a) h = (h ^ part) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
    return static_cast<std::size_t>(h);
  }
};

/// How often decisions with the same answers were no and yes.
struct Sample {
  Answers answers{};
  std::array<std::uint32_t, 2> count{};
};

/// Counts the decisions of sets of blocks, each `weight` times; of sets with bases those about blocks that
/// have one.
class SampleCollector {
 public:
  void add(const perception::BlockSet& set, std::uint32_t weight = 1,
           const perception::FindBase& find_base = {});
  std::vector<Sample> samples(int decision) const;

  bool decide(int decision, const perception::VoxelContext& context, bool value);
  std::uint32_t raw(std::uint32_t value, int) { return value; }
  std::uint32_t number(std::uint32_t value) { return value; }
  void begin(std::size_t) {}

 private:
  std::uint32_t weight_{1};
  bool with_base_only_{false};
  std::array<std::unordered_map<Answers, std::array<std::uint32_t, 2>, AnswersHash>, perception::kDecisions>
      counts_{};
};

/// Splits blocks into sets as they would share a piece: `blocks` a set, in the order in which they are.
std::vector<perception::BlockSet> sets_of(std::vector<perception::FineBlock> blocks, int level,
                                          std::size_t blocks_in_set);

}  // namespace adit::bench

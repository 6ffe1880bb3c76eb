// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/block_coder.hpp"

#include <algorithm>

#include "perception/stream/block_walk.hpp"

namespace adit::perception {
namespace {

/// Probabilities of the leaves, which begin as the tables say and follow what is coded, the slower the more
/// was coded.
class Model {
 public:
  struct Leaf {
    std::uint16_t one{};
    std::uint8_t seen{0};  ///< How often it was used, at most kOften.

    void learn(bool value) {
      // Measured on geb079: 1 % fewer bytes than with any fixed rate.
      const int rate = seen < kSome ? 4 : seen < kOften ? 5 : 6;
      const int step = value ? (65535 - one) >> rate : -(one >> rate);
      one = static_cast<std::uint16_t>(std::clamp(one + step, kRarest, 65535 - kRarest));
      if (seen < kOften) ++seen;
    }
  };

  Model() : trees_(ContextTrees::built_in()) {
    for (const ContextTrees::Node& node : trees_.nodes()) leaves_.push_back({node.next});
  }
  Leaf& at(int decision, const VoxelContext& context) { return leaves_[trees_.leaf(decision, context)]; }

 private:
  static constexpr std::uint8_t kSome = 6, kOften = 25;
  static constexpr int kRarest = 24;
  const ContextTrees& trees_;
  std::vector<Leaf> leaves_{};
};

class Writer {
 public:
  Writer(RangeEncoder& to, std::vector<std::uint32_t>* bits) : to_(to), bits_(bits) {}

  bool decide(int decision, const VoxelContext& context, bool value) {
    Model::Leaf& leaf = model_.at(decision, context);
    to_.bit(value, leaf.one);
    leaf.learn(value);
    return value;
  }
  std::uint32_t raw(std::uint32_t value, int count) {
    to_.bits(value, count);
    return value;
  }
  std::uint32_t number(std::uint32_t value) {
    to_.number(value);
    return value;
  }
  void begin(std::size_t block) {
    if (bits_ == nullptr) return;
    const std::size_t at = to_.position();
    if (block_ < bits_->size()) (*bits_)[block_] += static_cast<std::uint32_t>(at - since_);
    since_ = at;
    block_ = block;
  }

 private:
  Model model_{};
  RangeEncoder& to_;
  std::vector<std::uint32_t>* bits_;
  std::size_t block_{SIZE_MAX};
  std::size_t since_{0};
};

class Reader {
 public:
  explicit Reader(RangeDecoder& from) : from_(from) {}

  bool decide(int decision, const VoxelContext& context, bool) {
    Model::Leaf& leaf = model_.at(decision, context);
    const bool value = from_.bit(leaf.one);
    leaf.learn(value);
    return value;
  }
  std::uint32_t raw(std::uint32_t, int count) { return from_.bits(count); }
  std::uint32_t number(std::uint32_t) { return from_.number(); }
  void begin(std::size_t) {}

 private:
  Model model_{};
  RangeDecoder& from_;
};

}  // namespace

void write_blocks(RangeEncoder& to, const BlockSet& set, const FindBase& find_base,
                  std::vector<std::uint32_t>* bits) {
  if (bits != nullptr) bits->assign(set.indices.size(), 0);
  Writer writer(to, bits);
  BlockWalk<Writer>(writer, set.level, find_base).write(set);
  writer.begin(SIZE_MAX);
}

Result<BlockSet> read_blocks(RangeDecoder& from, int max_level, const FindBase& find_base) {
  Reader reader(from);
  using Walk = BlockWalk<Reader>;
  BlockSet set;
  switch (Walk(reader, max_level, find_base).read(set)) {
    case Walk::Read::good:
      return set;
    case Walk::Read::other_base:
      return {Reason::out_of_range, "changes of blocks of the map that are not here"};
    case Walk::Read::malformed:
      break;
  }
  return {Reason::malformed, "blocks of the map that make no sense"};
}

}  // namespace adit::perception

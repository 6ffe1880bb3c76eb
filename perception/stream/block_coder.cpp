// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/block_coder.hpp"

#include "perception/stream/block_walk.hpp"

namespace adit::perception {
namespace {

class Writer {
 public:
  Writer(RangeEncoder& to, std::vector<std::uint32_t>* bits) : to_(to), bits_(bits) {}

  bool decide(int decision, const VoxelContext& context, bool value) {
    to_.bit(value, trees_.probability(decision, context));
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
  const ContextTrees& trees_{ContextTrees::built_in()};
  RangeEncoder& to_;
  std::vector<std::uint32_t>* bits_;
  std::size_t block_{SIZE_MAX};
  std::size_t since_{0};
};

class Reader {
 public:
  explicit Reader(RangeDecoder& from) : from_(from) {}

  bool decide(int decision, const VoxelContext& context, bool) {
    return from_.bit(trees_.probability(decision, context));
  }
  std::uint32_t raw(std::uint32_t, int count) { return from_.bits(count); }
  std::uint32_t number(std::uint32_t) { return from_.number(); }
  void begin(std::size_t) {}

 private:
  const ContextTrees& trees_{ContextTrees::built_in()};
  RangeDecoder& from_;
};

}  // namespace

void write_blocks(RangeEncoder& to, const BlockSet& set, std::vector<std::uint32_t>* bits) {
  if (bits != nullptr) bits->assign(set.indices.size(), 0);
  Writer writer(to, bits);
  BlockWalk<Writer>(writer).write(set);
  writer.begin(SIZE_MAX);
}

Result<BlockSet> read_blocks(RangeDecoder& from) {
  Reader reader(from);
  BlockSet set;
  if (!BlockWalk<Reader>(reader).read(set) || from.overrun())
    return {Reason::malformed, "blocks of the map that make no sense"};
  return set;
}

}  // namespace adit::perception

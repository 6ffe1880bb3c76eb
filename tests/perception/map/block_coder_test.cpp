// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/block_coder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "core/store/crc32c.hpp"
#include "perception/map/export/octree_file.hpp"
#include "perception/stream/block_context.hpp"
#include "perception/stream/block_tables.hpp"
#include "perception/stream/block_walk.hpp"
#include "tests/folders/folders.hpp"

namespace adit::perception {
namespace {

std::vector<std::uint8_t> encoded(const BlockSet& set, std::vector<std::uint32_t>* bits = nullptr) {
  RangeEncoder encoder;
  write_blocks(encoder, set, {}, bits);
  return encoder.finish();
}

Result<BlockSet> decoded(std::span<const std::uint8_t> bytes) {
  RangeDecoder decoder(bytes);
  return read_blocks(decoder);
}

/// Blocks at random places within `reach`, with voxels of each kind at random.
BlockSet noise(std::size_t count, int level, std::int32_t reach, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::set<BlockIndex> indices;
  while (indices.size() < count) {
    const auto part = [&] {
      return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * reach - 1)) - reach + 1;
    };
    indices.insert({part(), part(), part()});
  }
  BlockSet set{level, {indices.begin(), indices.end()}, {}};
  const std::uint32_t kinds = 1 + random() % 9;
  for (std::size_t i = 0; i < count * set.voxels_in_block(); ++i)
    set.voxels.push_back(static_cast<Voxel>(std::min<std::uint32_t>(2, random() % kinds)));
  return set;
}

/// The building geb079 in voxels of 0.1 m, as OctoMap's package has it.
std::vector<FineBlock> building() {
  std::filesystem::path file = source_folder() + "/data/maps/geb079.bt";
  if (!std::filesystem::exists(file)) file = "/usr/share/doc/liboctomap-dev/examples/data/geb079.bt";
  std::ifstream from(file, std::ios::binary);
  std::ostringstream content;
  content << from.rdbuf();
  const auto image = read_octree(content.str());
  if (!image) return {};
  VoxelImage fine(0.1);
  fine.add(*image);
  std::map<BlockIndex, FineBlock> blocks;
  fine.for_each([&](const VoxelIndex& v, Voxel voxel) {
    FineBlock& block = blocks[{v.x >> 3, v.y >> 3, v.z >> 3}];
    const std::uint64_t bit = std::uint64_t{1} << ((v.x & 7) + 8 * (v.y & 7));
    block.index = {v.x >> 3, v.y >> 3, v.z >> 3};
    block.known[static_cast<std::size_t>(v.z & 7)] |= bit;
    if (voxel == Voxel::occupied) block.occupied[static_cast<std::size_t>(v.z & 7)] |= bit;
  });
  std::vector<FineBlock> out;
  for (const auto& [index, block] : blocks) out.push_back(block);
  return out;
}

TEST(BlockSet, ALevelHigherIsOccupiedWhereAPartIs) {
  BlockSet set = noise(4, 3, 5, 1);
  const std::vector<CoarseBlock> masks = coarse_blocks(coarser(set));
  EXPECT_EQ(block_set(masks), coarser(set));
  for (std::size_t b = 0; b < set.indices.size(); ++b)
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 4; ++y)
        for (int z = 0; z < 4; ++z) {
          Voxel most = Voxel::unknown;
          for (int part = 0; part < 8; ++part)
            most =
                std::max(most, set.voxels[512 * b + static_cast<std::size_t>(2 * x + (part & 1) +
                                                                             8 * (2 * y + (part >> 1 & 1)) +
                                                                             64 * (2 * z + (part >> 2)))]);
          ASSERT_EQ(masks[b].at(x, y, z), most);
        }
}

TEST(BlockCoder, ReadsWhatWasWritten) {
  std::uint32_t seed = 0;
  for (int level = 0; level < BlockSet::kLevels; ++level)
    for (const std::size_t count : {0u, 1u, 2u, 7u, 60u, 512u})
      for (const std::int32_t reach : {6, 40, BlockIndex::kLimit}) {
        const BlockSet set = noise(count, level, reach, ++seed);
        std::vector<std::uint32_t> bits;
        const auto bytes = encoded(set, &bits);
        EXPECT_EQ(bits.size(), count);
        const auto got = decoded(bytes);
        ASSERT_TRUE(got) << level << ' ' << count << ' ' << reach;
        ASSERT_EQ(*got, set) << level << ' ' << count << ' ' << reach;
      }
}

TEST(BlockCoder, UniformBlocksTakeBitsOfAByte) {
  std::vector<CoarseBlock> blocks;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 4; ++z) blocks.push_back({{x, y, z}, ~std::uint64_t{0}, 0});
  EXPECT_LT(8 * encoded(block_set(std::span<const CoarseBlock>(blocks))).size(), blocks.size());
}

TEST(BlockCoder, EachPieceOfARealMapDecodesAlone) {
  const auto blocks = building();
  ASSERT_GT(blocks.size(), 2000u);
  for (std::size_t at = 0; at < blocks.size(); at += 397) {
    BlockSet set = block_set(std::span(blocks).subspan(at, std::min<std::size_t>(97, blocks.size() - at)));
    for (; set.level > 0; set = coarser(set)) {
      const auto got = decoded(encoded(set));
      ASSERT_TRUE(got);
      ASSERT_EQ(*got, set);
    }
  }
}

/// Bytes a block at each level, without a piece's header; measured: see docs/map.md.
constexpr std::array<double, 4> kMost{0, 0.92, 3.7, 15.6};

TEST(BlockCoder, TheHalfOfARealMapThatTheTablesNeverSawStaysSmall) {
  std::vector<FineBlock> east;
  for (const FineBlock& block : building())
    if (block.index.x >= 0) east.push_back(block);
  ASSERT_GT(east.size(), 1000u);
  std::array<std::size_t, 4> bytes{};
  for (std::size_t at = 0; at < east.size(); at += 300) {
    BlockSet set = block_set(std::span(east).subspan(at, std::min<std::size_t>(300, east.size() - at)));
    for (; set.level > 0; set = coarser(set))
      bytes[static_cast<std::size_t>(set.level)] += encoded(set).size();
  }
  const auto per_block = [&](int level) {
    return static_cast<double>(bytes[static_cast<std::size_t>(level)]) / static_cast<double>(east.size());
  };
  EXPECT_LT(per_block(1), kMost[1]);
  EXPECT_LT(per_block(2), kMost[2]);
  EXPECT_LT(per_block(3), kMost[3]);
}

TEST(BlockCoder, AnyBytesGiveABoundedSetOrAnError) {
  std::mt19937 random(29);
  std::size_t sets = 0;
  const auto complete = encoded(noise(60, 2, 6, 5));
  for (int n = 0; n < 1000; ++n) {
    std::vector<std::uint8_t> bytes = complete;
    if (n % 2 == 0) {
      bytes.resize(random() % 1200);
      for (std::uint8_t& byte : bytes)
        byte = static_cast<std::uint8_t>(n % 4 == 0 ? random() : random() % 16);
    } else {
      for (int i = 0; i < 3; ++i)
        bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
      if (n % 3 == 0) bytes.resize(random() % bytes.size());
    }
    const auto got = decoded(bytes);
    if (!got) continue;
    ++sets;
    ASSERT_LE(got->indices.size(), kMaxSetBlocks);
    ASSERT_EQ(got->voxels.size(), got->indices.size() * got->voxels_in_block());
    ASSERT_TRUE(std::is_sorted(got->indices.begin(), got->indices.end()));
    for (const BlockIndex& index : got->indices) ASSERT_TRUE(is_within_limit(index));
    // What was read can be written again.
    ASSERT_EQ(*decoded(encoded(*got)), *got);
  }
  EXPECT_GT(sets, 50u);
}

TEST(ContextTrees, OtherTablesHaveAnotherVersion) {
  const std::string_view text(kBlockTables, kBlockTablesSize);
  const std::uint32_t sum = crc32c({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  // Robots and stations decode each other's pieces only with equal tables: other tables need another version.
  EXPECT_EQ(ContextTrees::kVersion, 2);
  EXPECT_EQ(sum, 2351582338u);
}

TEST(ContextTrees, TextThatIsDamagedGivesEvenProbabilities) {
  const std::array<std::uint8_t, 27> around{};
  const auto steps = neighbour_steps(3, 7);
  const VoxelContext context{&around[13], &steps, &around[13], &steps, 0, 2};
  for (const std::string text :
       {"", "#", "\\\\", "~~~~~~~~", "zzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz"}) {
    const ContextTrees trees(text);
    for (int decision = 0; decision < kDecisions; ++decision)
      EXPECT_EQ(trees.nodes()[trees.leaf(decision, context)].next, 1u << 15) << text;
  }
  EXPECT_GT(ContextTrees::built_in().nodes().size(), 500u);
}

/// An older state of blocks: of every other one nothing, of the others about a third of the voxels fewer, and
/// one voxel of ten the other way round.
std::map<BlockIndex, CoarseBlock> older(const std::vector<CoarseBlock>& blocks, std::uint32_t seed) {
  std::mt19937_64 random(seed);
  std::map<BlockIndex, CoarseBlock> out;
  for (const CoarseBlock& block : blocks) {
    if (random() % 2 == 0) continue;
    const std::uint64_t known = block.known & (random() | random()), other = random() & random() & random();
    if (known != 0) out[block.index] = {block.index, known, (block.occupied ^ other) & known};
  }
  return out;
}

FindBase finder(const std::map<BlockIndex, CoarseBlock>& bases) {
  return [&bases](const BlockIndex& index) {
    const auto found = bases.find(index);
    return found != bases.end() ? std::optional(found->second) : std::nullopt;
  };
}

std::vector<std::uint8_t> changes(const BlockSet& set, const FindBase& base) {
  RangeEncoder encoder;
  write_blocks(encoder, set, base);
  return encoder.finish();
}

Result<BlockSet> applied(std::span<const std::uint8_t> bytes, const FindBase& base) {
  RangeDecoder decoder(bytes);
  return read_blocks(decoder, 2, base);
}

TEST(BlockBaseTest, DecodesChangesOfAnyBlock) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const BlockSet set = noise(1 + seed % 60, 2, 4, seed);
    const auto bases = older(coarse_blocks(set), seed);
    const auto read = applied(changes(set, finder(bases)), finder(bases));
    ASSERT_TRUE(read.ok()) << read.error().text << " seed " << seed;
    ASSERT_EQ(*read, set) << "seed " << seed;
  }
}

TEST(BlockBaseTest, AFewMoreVoxelsOfABuildingTakeAFractionOfTheBlocks) {
  const std::vector<FineBlock> fine = building();
  ASSERT_GT(fine.size(), 1000U);
  BlockSet set = coarser(block_set(std::span(fine).first(300)));
  std::map<BlockIndex, CoarseBlock> bases;
  for (const CoarseBlock& block : coarse_blocks(set)) {
    const std::uint64_t known = block.known & ~(0xfULL << (block.index.x & 3) * 16);
    bases[block.index] = {block.index, known, block.occupied & known};
  }
  const std::size_t all = changes(set, {}).size(), few = changes(set, finder(bases)).size();
  EXPECT_LT(few, all * 6 / 10) << all;
  EXPECT_EQ(applied(changes(set, finder(bases)), finder(bases)).value(), set);
}

TEST(BlockBaseTest, AnotherBaseIsFoundBeforeAnythingIsRead) {
  const BlockSet set = noise(20, 2, 3, 5);
  const auto bases = older(coarse_blocks(set), 5);
  const auto bytes = changes(set, finder(bases));
  for (const auto& [index, base] : bases) {
    auto other = bases;
    other[index].known ^= 1;
    EXPECT_EQ(applied(bytes, finder(other)).reason(), Reason::out_of_range);
    other.erase(index);
    EXPECT_EQ(applied(bytes, finder(other)).reason(), Reason::out_of_range);
  }
  EXPECT_EQ(applied(bytes, {}).reason(), Reason::out_of_range);
}

TEST(BlockBaseTest, ABaseThatKnowsMoreIsNotUsed) {
  const BlockSet set = noise(20, 2, 3, 6);
  const auto everything = [](const BlockIndex& index) {
    return std::optional<CoarseBlock>({index, ~0ULL, 0});
  };
  EXPECT_EQ(changes(set, everything), changes(set, {}));
}

}  // namespace
}  // namespace adit::perception

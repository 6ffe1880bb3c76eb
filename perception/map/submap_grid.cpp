// SPDX-License-Identifier: Apache-2.0
#include "perception/map/submap_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "perception/map/log_odds.hpp"
#include "perception/map/scan_masks.hpp"

namespace adit::perception {
namespace {

using VoxelBytes = std::array<std::uint8_t, 512>;

/// Applies a scan to the voxels of a block; returns whether one changed.
bool apply(const ScanBlock& scan, VoxelBytes& voxels) {
  log_odds::Lanes changed{};
  for (int z = 0; z < 8; ++z) {
    const std::uint64_t hit = scan.hit[z], miss = scan.free[z] & ~hit;
    if ((hit | miss) == 0) continue;
    for (int part = 0; part < 4; ++part) {
      std::uint8_t* at = voxels.data() + 64 * z + 16 * part;
      log_odds::Lanes old;
      std::memcpy(&old, at, sizeof old);
      const log_odds::Lanes made =
          log_odds::update(old, log_odds::spread(hit >> 16 * part), log_odds::spread(miss >> 16 * part));
      std::memcpy(at, &made, sizeof made);
      changed |= old ^ made;
    }
  }
  std::uint64_t halves[2];
  std::memcpy(halves, &changed, sizeof halves);
  return (halves[0] | halves[1]) != 0;
}

/// Voxels of eight that must be free for the coarse one to be free: its centre then is, and not only a corner
/// of it in front of a wall.
constexpr int kLeastFree = 7;

/// The coarse masks of a block: one occupied voxel of eight makes the coarse one occupied, else most of them
/// must be known to be free.
CoarseBlock coarse_masks(const VoxelBytes& voxels) {
  CoarseBlock out;
  for (int z = 0; z < 4; ++z) {
    for (int half = 0; half < 4; ++half) {  // Rows 2 half and 2 half + 1 of layers 2 z and 2 z + 1.
      const std::uint8_t* at = voxels.data() + 128 * z + 16 * half;
      log_odds::Lanes low, high;
      std::memcpy(&low, at, sizeof low);
      std::memcpy(&high, at + 64, sizeof high);
      const log_odds::Lanes both = low > high ? low : high;
      const auto known = (low != 0) + (high != 0);  // Lanes of 0, -1 or -2.
      std::uint8_t row[16];
      std::int8_t seen[16];
      std::memcpy(row, &both, sizeof row);
      std::memcpy(seen, &known, sizeof seen);
      for (int x = 0; x < 4; ++x) {
        const std::uint8_t top =
            std::max(std::max(row[2 * x], row[2 * x + 1]), std::max(row[2 * x + 8], row[2 * x + 9]));
        const int bit = x + 4 * half + 16 * z;
        const int count = -(seen[2 * x] + seen[2 * x + 1] + seen[2 * x + 8] + seen[2 * x + 9]);
        const bool occupied = top >= log_odds::kLeastOccupied;
        out.known |= std::uint64_t{occupied || count >= kLeastFree} << bit;
        out.occupied |= std::uint64_t{occupied} << bit;
      }
    }
  }
  return out;
}

bool all_surely_free(const VoxelBytes& voxels) {
  return voxels[0] == log_odds::kSurelyFree &&
         std::memcmp(voxels.data(), voxels.data() + 1, voxels.size() - 1) == 0;
}

bool any_hit(const ScanBlock& scan) {
  std::uint64_t all = 0;
  for (const std::uint64_t layer : scan.hit) all |= layer;
  return all != 0;
}

}  // namespace

SubmapGrid::SubmapGrid(double resolution)
    : resolution_(std::isfinite(resolution) ? std::clamp(resolution, 0.01, 1.0) : 0.1) {}

std::uint32_t SubmapGrid::Pool::take(std::uint8_t value) {
  std::uint32_t position = made_;
  if (!unused_.empty()) {
    position = unused_.back();
    unused_.pop_back();
  } else {
    if (made_ % kChunk == 0) chunks_.push_back(std::make_unique<Chunk>());
    ++made_;
  }
  (*this)[position].fill(value);
  return position;
}

std::size_t SubmapGrid::Pool::bytes() const {
  return chunks_.size() * sizeof(Chunk) + chunks_.capacity() * sizeof(chunks_[0]) +
         unused_.capacity() * sizeof(unused_[0]);
}

void SubmapGrid::insert(const Eigen::Vector3f& origin, std::span<const Eigen::Vector3f> points,
                        float max_range, std::span<const std::uint8_t> moving) {
  // One workspace a thread: its content never outlives a call, its memory does.
  thread_local ScanMasks masks;
  masks.trace({origin, points, moving, max_range}, resolution_,
              [this](int x, int y, int z) { return value(x, y, z) >= log_odds::kLeastOccupied; });
  const std::uint32_t revision = revision_ + 1;
  for (const ScanBlock& scan : masks.blocks()) {
    if (!is_within_limit(scan.index)) continue;
    const std::uint64_t key = block_key(scan.index);
    std::uint32_t position = hash_.find(key);
    if (position == hash_.kNone) {
      if (hash_.size() >= kMaxBlocks) continue;
      position = hash_.find_or_add(key);
    }
    Block& block = hash_[position].value;
    if (block.voxels == kFreeBlock && !any_hit(scan)) continue;
    if (block.voxels >= kFreeBlock)
      block.voxels = pool_.take(block.voxels == kFreeBlock ? log_odds::kSurelyFree : log_odds::kUnknown);
    Voxels& voxels = pool_[block.voxels];
    if (!apply(scan, voxels)) continue;
    revision_ = revision;
    const CoarseBlock masks_now = coarse_masks(voxels);
    if (masks_now.known != block.known || masks_now.occupied != block.occupied) block.revision = revision;
    block.known = masks_now.known;
    block.occupied = masks_now.occupied;
    if (!all_surely_free(voxels)) continue;
    pool_.give_back(block.voxels);
    block.voxels = kFreeBlock;
  }
}

std::uint8_t SubmapGrid::value(int x, int y, int z) const {
  const BlockIndex index{x >> 3, y >> 3, z >> 3};
  if (!is_within_limit(index)) return log_odds::kUnknown;
  const std::uint32_t position = hash_.find(block_key(index));
  if (position == hash_.kNone) return log_odds::kUnknown;
  const std::uint32_t voxels = hash_[position].value.voxels;
  if (voxels == kFreeBlock) return log_odds::kSurelyFree;
  if (voxels == kUnknownBlock) return log_odds::kUnknown;
  return pool_[voxels][(x & 7) + 8 * (y & 7) + 64 * (z & 7)];
}

Voxel SubmapGrid::at(const Eigen::Vector3f& point) const {
  const Eigen::Vector3d voxel = (point.cast<double>() / resolution_).array().floor();
  if (!voxel.allFinite() || voxel.cwiseAbs().maxCoeff() > 8.0 * BlockIndex::kLimit) return Voxel::unknown;
  return log_odds::classify(
      value(static_cast<int>(voxel.x()), static_cast<int>(voxel.y()), static_cast<int>(voxel.z())));
}

void SubmapGrid::for_each_block(
    const std::function<void(const BlockIndex&, std::uint32_t revision)>& visit) const {
  for (const std::uint32_t position : hash_.sorted())
    visit(block_of_key(hash_[position].key), hash_[position].value.revision);
}

std::optional<CoarseBlock> SubmapGrid::coarse(const BlockIndex& index) const {
  const std::uint32_t position = is_within_limit(index) ? hash_.find(block_key(index)) : hash_.kNone;
  if (position == hash_.kNone) return std::nullopt;
  const Block& block = hash_[position].value;
  return CoarseBlock{index, block.known, block.occupied};
}

std::optional<FineBlock> SubmapGrid::fine(const BlockIndex& index) const {
  const std::uint32_t position = is_within_limit(index) ? hash_.find(block_key(index)) : hash_.kNone;
  if (position == hash_.kNone) return std::nullopt;
  FineBlock out{index, {}, {}};
  const std::uint32_t voxels = hash_[position].value.voxels;
  if (voxels == kFreeBlock) out.known.fill(~std::uint64_t{0});
  if (voxels >= kFreeBlock) return out;
  const Voxels& values = pool_[voxels];
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.known[i >> 6] |= std::uint64_t{values[i] != log_odds::kUnknown} << (i & 63);
    out.occupied[i >> 6] |= std::uint64_t{values[i] >= log_odds::kLeastOccupied} << (i & 63);
  }
  return out;
}

std::vector<BlockIndex> SubmapGrid::changed_since(std::uint32_t revision) const {
  std::vector<std::uint64_t> keys;
  for (const auto& entry : hash_.entries())
    if (entry.value.revision > revision) keys.push_back(entry.key);
  std::sort(keys.begin(), keys.end());
  std::vector<BlockIndex> changed;
  changed.reserve(keys.size());
  for (const std::uint64_t key : keys) changed.push_back(block_of_key(key));
  return changed;
}

std::size_t SubmapGrid::bytes() const { return sizeof *this + hash_.bytes() + pool_.bytes(); }

}  // namespace adit::perception

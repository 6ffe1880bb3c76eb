// SPDX-License-Identifier: Apache-2.0
#include "perception/map/voxel_image.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr std::uint8_t kUnknownVote = 0, kFreeVote = 1, kOccupiedVote = 2;
/// A coarser image has voxels in whose centre no occupied voxel of a submap needs to lie: all of those vote.
constexpr double kCoarser = 1.01;

constexpr int kReach = 8 * (BlockIndex::kLimit - 1);  ///< Largest index of a voxel.

bool reaches(const VoxelIndex& v) {
  return std::abs(v.x) < kReach && std::abs(v.y) < kReach && std::abs(v.z) < kReach;
}

std::uint64_t key_of(const VoxelIndex& v) { return block_key({v.x >> 3, v.y >> 3, v.z >> 3}); }
int place_of(const VoxelIndex& v) { return (v.x & 7) + 8 * (v.y & 7) + 64 * (v.z & 7); }

VoxelIndex voxel_in(std::uint64_t key, int place) {
  const BlockIndex b = block_of_key(key);
  return {8 * b.x + (place & 7), 8 * b.y + (place >> 3 & 7), 8 * b.z + (place >> 6)};
}

}  // namespace

VoxelImage::VoxelImage(double resolution)
    : resolution_(std::isfinite(resolution) ? std::clamp(resolution, 0.01, 10.0) : 0.2) {}

Voxel VoxelImage::decide(std::uint8_t votes) {
  const int newest = votes & 3, second = votes >> 2 & 3, third = votes >> 4 & 3;
  if (newest == kUnknownVote) return Voxel::unknown;
  if (newest == kOccupiedVote || (second == kOccupiedVote && third == kOccupiedVote)) return Voxel::occupied;
  return Voxel::free;
}

std::uint32_t VoxelImage::block_at(std::uint64_t key) {
  const std::uint32_t position = hash_.find(key);
  if (position != hash_.kNone) return position;
  if (hash_.size() < kMaxBlocks) return hash_.find_or_add(key);
  ++left_out_;
  return hash_.kNone;
}

void VoxelImage::vote(const VoxelIndex& index, Voxel voxel) {
  if (voxel == Voxel::unknown) return;
  if (!reaches(index)) {
    ++left_out_;
    return;
  }
  const std::uint64_t key = key_of(index);
  std::uint32_t position = voted_.empty() ? hash_.kNone : voted_.back();
  if (position == hash_.kNone || hash_[position].key != key) {
    position = block_at(key);
    if (position == hash_.kNone) return;
    voted_.push_back(position);
  }
  std::uint8_t& votes = hash_[position].value[place_of(index)];
  const std::uint8_t made = voxel == Voxel::occupied ? kOccupiedVote : kFreeVote;
  if ((votes & kVoted) == 0)
    votes = static_cast<std::uint8_t>((votes << 2 & 0x3f) | made | kVoted);
  else if (made == kOccupiedVote)  // Two voxels of one submap: occupied wins.
    votes = static_cast<std::uint8_t>((votes & ~3) | made);
}

void VoxelImage::end_votes() {
  std::sort(voted_.begin(), voted_.end());
  voted_.erase(std::unique(voted_.begin(), voted_.end()), voted_.end());
  for (const std::uint32_t position : voted_)
    for (std::uint8_t& votes : hash_[position].value) votes &= static_cast<std::uint8_t>(~kVoted);
  voted_.clear();
}

VoxelIndex VoxelImage::index_of(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d v = (point / resolution_).array().floor();
  if (!v.allFinite() || v.cwiseAbs().maxCoeff() >= kReach) return {kReach, kReach, kReach};
  return {static_cast<int>(v.x()), static_cast<int>(v.y()), static_cast<int>(v.z())};
}

bool VoxelImage::in_reach(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double resolution) {
  return low.allFinite() && high.allFinite() &&
         std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()) < resolution * (kReach - 2);
}

template <class Block>
void VoxelImage::add_blocks(const Pose3& T_map_submap, std::span<const Block> blocks, double edge) {
  constexpr int kEdge = Block::kEdge;
  const Eigen::Matrix3d rotation = T_map_submap.orientation.normalized().toRotationMatrix();
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * kEdge * edge);
  const Eigen::Vector3d reach = rotation.cwiseAbs() * half;
  const bool coarser = resolution_ > kCoarser * edge;
  const Eigen::Matrix3d step = rotation.transpose() * (resolution_ / edge);
  for (const Block& block : blocks) {
    const Eigen::Vector3d corner =
        kEdge * edge * Eigen::Vector3d(block.index.x, block.index.y, block.index.z);
    const Eigen::Vector3d middle = rotation * (corner + half) + T_map_submap.position;
    if (!in_reach(middle - reach, middle + reach, resolution_)) {
      ++left_out_;
      continue;
    }
    const VoxelIndex low = index_of(middle - reach), high = index_of(middle + reach);
    std::array<bool, kEdge * kEdge * kEdge> seen{};
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y) {
        const Eigen::Vector3d first =
            (rotation.transpose() * (centre({low.x, y, z}) - T_map_submap.position) - corner) / edge;
        for (int x = low.x; x <= high.x; ++x) {
          const Eigen::Vector3d v = (first + step.col(0) * (x - low.x)).array().floor();
          if (v.minCoeff() < 0.0 || v.maxCoeff() >= kEdge) continue;
          const int i = static_cast<int>(v.x()), j = static_cast<int>(v.y()), k = static_cast<int>(v.z());
          seen[static_cast<std::size_t>(i + kEdge * (j + kEdge * k))] = true;
          vote({x, y, z}, block.at(i, j, k));
        }
      }
    for (int place = 0; place < kEdge * kEdge * kEdge; ++place) {
      const int i = place % kEdge, j = place / kEdge % kEdge, k = place / (kEdge * kEdge);
      if ((seen[static_cast<std::size_t>(place)] && !coarser) || block.at(i, j, k) != Voxel::occupied)
        continue;
      const Eigen::Vector3d own = corner + edge * (Eigen::Vector3d(i, j, k).array() + 0.5).matrix();
      vote(index_of(rotation * own + T_map_submap.position), Voxel::occupied);
    }
  }
  end_votes();
}

void VoxelImage::add(const Pose3& T_map_submap, std::span<const CoarseBlock> blocks, double edge) {
  if (!T_map_submap.position.allFinite() || !T_map_submap.orientation.coeffs().allFinite()) return;
  if (!(edge >= 0.01 && edge <= 10.0)) return;
  add_blocks(T_map_submap, blocks, edge);
}

void VoxelImage::add(const Pose3& T_map_submap, const SubmapGrid& grid) {
  std::vector<FineBlock> blocks;
  blocks.reserve(grid.blocks());
  grid.for_each_block([&](const BlockIndex& index, std::uint32_t) { blocks.push_back(*grid.fine(index)); });
  add_blocks(T_map_submap, std::span<const FineBlock>(blocks), grid.resolution());
}

void VoxelImage::add(const VoxelImage& image) {
  std::vector<FineBlock> blocks;
  for (const std::uint32_t position : image.hash_.sorted()) {
    FineBlock block{block_of_key(image.hash_[position].key), {}, {}};
    for (int i = 0; i < 512; ++i) {
      const Voxel voxel = decide(image.hash_[position].value[static_cast<std::size_t>(i)]);
      block.known[i >> 6] |= std::uint64_t{voxel != Voxel::unknown} << (i & 63);
      block.occupied[i >> 6] |= std::uint64_t{voxel == Voxel::occupied} << (i & 63);
    }
    blocks.push_back(block);
  }
  add_blocks(Pose3{}, std::span<const FineBlock>(blocks), image.resolution_);
}

bool VoxelImage::set(const VoxelIndex& index, Voxel voxel) {
  const std::uint64_t before = left_out_;
  vote(index, voxel);
  if (!voted_.empty()) hash_[voted_.back()].value[place_of(index)] &= static_cast<std::uint8_t>(~kVoted);
  voted_.clear();
  return left_out_ == before;
}

bool VoxelImage::set_block(const BlockIndex& index, Voxel voxel) {
  if (voxel == Voxel::unknown) return true;
  const std::uint32_t position = is_within_limit(index) ? block_at(block_key(index)) : hash_.kNone;
  if (position == hash_.kNone) return false;
  const std::uint8_t made = voxel == Voxel::occupied ? kOccupiedVote : kFreeVote;
  for (std::uint8_t& votes : hash_[position].value)
    votes = static_cast<std::uint8_t>((votes << 2 & 0x3f) | made);
  return true;
}

Voxel VoxelImage::at(const VoxelIndex& index) const {
  if (!reaches(index)) return Voxel::unknown;
  const std::uint32_t position = hash_.find(key_of(index));
  if (position == hash_.kNone) return Voxel::unknown;
  return decide(hash_[position].value[static_cast<std::size_t>(place_of(index))]);
}

Voxel VoxelImage::at(const Eigen::Vector3d& point) const { return at(index_of(point)); }

void VoxelImage::for_each(const std::function<void(const VoxelIndex&, Voxel)>& visit) const {
  for (const std::uint32_t position : hash_.sorted())
    for (int place = 0; place < 512; ++place) {
      const Voxel voxel = decide(hash_[position].value[static_cast<std::size_t>(place)]);
      if (voxel != Voxel::unknown) visit(voxel_in(hash_[position].key, place), voxel);
    }
}

bool VoxelImage::empty() const {
  for (const auto& entry : hash_.entries())
    for (const std::uint8_t votes : entry.value)
      if (decide(votes) != Voxel::unknown) return false;
  return true;
}

std::size_t VoxelImage::count(Voxel kind) const {
  std::size_t n = 0;
  for (const auto& entry : hash_.entries())
    for (const std::uint8_t votes : entry.value) n += decide(votes) == kind;
  return n;
}

std::vector<VoxelIndex> VoxelImage::occupied() const {
  std::vector<VoxelIndex> out;
  for_each([&](const VoxelIndex& index, Voxel voxel) {
    if (voxel == Voxel::occupied) out.push_back(index);
  });
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<VoxelImage::Bounds> VoxelImage::bounds() const {
  std::optional<Bounds> out;
  for_each([&](const VoxelIndex& v, Voxel) {
    if (!out) out = Bounds{v, v};
    out->low = {std::min(out->low.x, v.x), std::min(out->low.y, v.y), std::min(out->low.z, v.z)};
    out->high = {std::max(out->high.x, v.x), std::max(out->high.y, v.y), std::max(out->high.z, v.z)};
  });
  return out;
}

std::vector<CoarseBlock> VoxelImage::coarse_blocks() const {
  VoxelImage coarse(CoarseBlock::kVoxel);
  const bool same = std::abs(resolution_ - coarse.resolution_) < 1e-6;
  if (!same) coarse.add(*this);
  const VoxelImage& image = same ? *this : coarse;
  BlockHash<std::array<std::uint64_t, 2>> made;
  image.for_each([&](const VoxelIndex& v, Voxel voxel) {
    const BlockIndex index{v.x >> 2, v.y >> 2, v.z >> 2};
    if (!is_within_limit(index)) return;
    auto& masks = made[made.find_or_add(block_key(index))].value;
    const std::uint64_t bit = std::uint64_t{1} << ((v.x & 3) + 4 * (v.y & 3) + 16 * (v.z & 3));
    masks[0] |= bit;
    if (voxel == Voxel::occupied) masks[1] |= bit;
  });
  std::vector<CoarseBlock> out;
  for (const std::uint32_t position : made.sorted())
    out.push_back({block_of_key(made[position].key), made[position].value[0], made[position].value[1]});
  return out;
}

}  // namespace adit::perception

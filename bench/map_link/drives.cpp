// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/drives.hpp"

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

#include "bench/map_link/ground.hpp"
#include "perception/map/export/octree_file.hpp"
#include "sim/world/lidar.hpp"

namespace adit::bench {
namespace {

constexpr double kHeight = 0.5;     ///< Of the lidar above the ground, m.
constexpr double kStep = 0.4;       ///< Between two scans, m.
constexpr double kBatch = 3.0;      ///< Between two batches, m.
constexpr float kMaxRange = 20.0f;  ///< m

}  // namespace

Result<MapDrive> drive_through(std::string_view name, std::uint64_t seed, double length) {
  const auto ground = make_ground(name, seed);
  if (!ground) return ground.error();
  Eigen::Vector2d at = ground->start;
  std::mt19937_64 random(seed * 977 + 5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const sim::LidarPattern lidar{sim::LidarParams{}};
  MapDrive out;
  out.world = std::string(name) + " " + std::to_string(seed);
  // A submap's axes are those of the first pose, which are not the world's.
  const Pose3 T_submap_world = Pose3::level({0.13, -0.21, uniform(random) * std::numbers::pi}, 0.04);
  double heading = uniform(random) * std::numbers::pi, driven = 0.0, in_batch = 0.0;
  std::uint32_t sent = 0;
  for (std::uint64_t n = 1; driven < length; ++n) {
    const double z = ground->height(at);
    const Pose3 base = Pose3::level({at.x(), at.y(), heading}, z + 0.02 * uniform(random));
    PointCloud points = lidar.scan(ground->world, {}, base, kHeight, n + 1000 * seed);
    for (Eigen::Vector3f& p : points) p = (T_submap_world * (base * p.cast<double>())).cast<float>();
    out.grid.insert((T_submap_world * (base * Eigen::Vector3d(0, 0, kHeight))).cast<float>(), points,
                    kMaxRange);
    for (int attempt = 0; attempt < 60; ++attempt) {
      const double turn =
          attempt == 0 ? 0.15 * uniform(random) : attempt * 0.05 * uniform(random) * std::numbers::pi;
      const Eigen::Vector2d next =
          at + kStep * Eigen::Vector2d(std::cos(heading + turn), std::sin(heading + turn));
      if (!ground->can_stand(next, z)) continue;
      heading += turn;
      at = next;
      break;
    }
    driven += kStep;
    in_batch += kStep;
    if (in_batch < kBatch && driven < length) continue;
    in_batch = 0.0;
    BlockBatch batch;
    for (const perception::BlockIndex& index : out.grid.changed_since(sent))
      batch.push_back(*out.grid.fine(index));
    sent = out.grid.revision();
    out.batches.push_back(std::move(batch));
  }
  return out;
}

Result<perception::VoxelImage> building_map() {
  const auto file = building_file();
  if (!file) return file.error();
  std::ifstream from(*file, std::ios::binary);
  std::ostringstream content;
  content << from.rdbuf();
  const auto image = perception::read_octree(content.str());
  if (!image) return image.error();
  perception::VoxelImage out(0.1);
  out.add(*image);
  return out;
}

std::vector<perception::FineBlock> fine_blocks(const perception::VoxelImage& image) {
  std::map<perception::BlockIndex, perception::FineBlock> blocks;
  image.for_each([&](const perception::VoxelIndex& v, perception::Voxel voxel) {
    const perception::BlockIndex index{v.x >> 3, v.y >> 3, v.z >> 3};
    perception::FineBlock& block = blocks[index];
    block.index = index;
    const std::uint64_t bit = std::uint64_t{1} << ((v.x & 7) + 8 * (v.y & 7));
    block.known[static_cast<std::size_t>(v.z & 7)] |= bit;
    if (voxel == perception::Voxel::occupied) block.occupied[static_cast<std::size_t>(v.z & 7)] |= bit;
  });
  std::vector<perception::FineBlock> out;
  for (const auto& [index, block] : blocks) out.push_back(block);
  return out;
}

std::vector<perception::FineBlock> fine_blocks(const perception::SubmapGrid& grid) {
  std::vector<perception::FineBlock> out;
  grid.for_each_block(
      [&](const perception::BlockIndex& index, std::uint32_t) { out.push_back(*grid.fine(index)); });
  return out;
}

}  // namespace adit::bench

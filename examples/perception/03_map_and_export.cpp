// SPDX-License-Identifier: Apache-2.0
// A voxel map of clouds at known poses, for other programs: example_map CLOUDS POSES.tum OUT
// writes OUT.bt (OctoMap), OUT.pcd and OUT.pgm with OUT.yaml (map_server).
#include <cstdio>
#include <string>

#include "perception/map/export/map_file.hpp"
#include "perception/map/submap_grid.hpp"
#include "perception/map/voxel_image.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/cloud/tum_file.hpp"

using namespace adit;

namespace {

int failed(const Error& error) {
  std::fprintf(stderr, "%s\n", error.text.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return failed({Reason::bad_argument, "usage: example_map CLOUDS POSES.tum OUT"});
  const auto files = sim::cloud_files(argv[1]);
  if (!files) return failed(files.error());
  const auto poses = sim::read_tum(argv[2]);
  if (!poses) return failed(poses.error());
  constexpr double kEdge = 0.1;    // m
  constexpr float kRange = 20.0f;  // m
  perception::SubmapGrid grid(kEdge);
  for (std::size_t n = 0; n < files->size() && n < poses->size(); ++n) {
    const auto cloud = sim::read_cloud((*files)[n]);
    if (!cloud) return failed(cloud.error());
    const Pose3& pose = (*poses)[n].pose;
    PointCloud points;
    for (const Eigen::Vector3f& p : *cloud)
      points.push_back((pose * Eigen::Vector3d(p.cast<double>())).cast<float>());
    grid.insert(pose.position.cast<float>(), points, kRange);
  }
  perception::VoxelImage image(kEdge);
  image.add(Pose3{}, grid);
  for (const char* extension : {".bt", ".pcd", ".pgm"})
    if (const auto saved = perception::save_map(image, argv[3] + std::string(extension)); !saved)
      return failed(saved.error());
  std::printf("%zu voxels occupied, %zu free\n", image.occupied_count(), image.free_count());
}

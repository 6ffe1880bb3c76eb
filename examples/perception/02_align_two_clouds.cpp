// SPDX-License-Identifier: Apache-2.0
// Where one cloud lies in another one's frame: example_align TARGET SOURCE
#include <cstdio>

#include "perception/odometry/align.hpp"
#include "sim/cloud/cloud_file.hpp"

using namespace adit;

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: example_align TARGET SOURCE\n"), 2;
  const auto target = sim::read_cloud(argv[1]), source = sim::read_cloud(argv[2]);
  if (!target || !source)
    return std::fprintf(stderr, "%s\n", (target ? source : target).error().text.c_str()), 2;
  const perception::VoxelPlanes planes = perception::align_target(*target);
  // Also finds a source that is up to half a metre and ten degrees away from where it is expected.
  const perception::Alignment found =
      perception::align(planes, *source, Pose3{}, {.search_distance = 0.5, .search_angle = 0.17});
  const Eigen::Vector3d& t = found.pose.position;
  std::printf("(%.3f, %.3f, %.3f) m, yaw %.2f degrees, overlap %.2f, %.3f m from the planes\n", t.x(), t.y(),
              t.z(), found.pose.yaw() * 180 / M_PI, found.overlap, found.rmse);
  return found.overlap >= perception::kAlignOverlap ? 0 : 1;
}

// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "perception/odometry/registration.hpp"
#include "perception/voxel/thin.hpp"
#include "perception/voxel/voxel_planes.hpp"
#include "sim/cloud/cloud_file.hpp"
#include "sim/navtool/cpu_time.hpp"
#include "sim/perctool/commands.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::perctool {

int align(const AlignOptions& options) {
  const auto target = read_cloud(options.target);
  if (!target) return report_error("perctool", target.error());
  const auto source = read_cloud(options.source);
  if (!source) return report_error("perctool", source.error());
  const double begin = navtool::cpu_ms();
  perception::Thinner dense({.wanted = 20'000, .min_edge = 0.05f}), thinner({.wanted = 4000});
  std::vector<Eigen::Vector3d> wide;
  for (const Eigen::Vector3f& p : dense.thin(*target)) wide.push_back(p.cast<double>());
  const std::vector<Eigen::Vector3f> points = thinner.thin(*source);
  // From far to near: a point meets planes in its own voxel alone, so those begin large.
  struct Stage {
    float finest;  ///< Edge of the smallest voxels, m.
    double window;
  };
  std::vector<perception::VoxelPlanes> maps;
  constexpr std::array kStages{Stage{1.0f, 1.0}, Stage{0.5f, 0.3}, Stage{0.25f, 0.05}};
  for (const Stage& stage : kStages) {
    maps.emplace_back(perception::VoxelPlanes::Params{.finest = stage.finest});
    maps.back().insert(wide, 0.0);
  }
  const double prepared = navtool::cpu_ms();
  perception::RegistrationParams params;
  params.max_iterations = 20;
  params.has_prior = false;
  perception::Registration registration(params);
  perception::Registered found;
  found.pose = options.guess;
  for (std::size_t n = 0; n < kStages.size(); ++n)
    found = registration.align(maps[n], points, found.pose, Eigen::Matrix<double, 6, 6>::Zero(),
                               kStages[n].window);
  const double end = navtool::cpu_ms();
  const Eigen::Vector3d& t = found.pose.position;
  const Eigen::Quaterniond& q = found.pose.orientation;
  const double overlap =
      points.empty() ? 0.0 : static_cast<double>(found.matched) / static_cast<double>(points.size());
  const nlohmann::ordered_json out{{"pose", {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}},
                                   {"overlap", overlap},
                                   {"rmse", found.rms},
                                   {"align_ms", end - prepared},
                                   {"total_ms", end - begin}};
  if (options.json)
    std::printf("%s\n", out.dump().c_str());
  else
    std::printf("%.4f %.4f %.4f %.6f %.6f %.6f %.6f, overlap %.2f, %.3f m, %.1f ms\n", t.x(), t.y(), t.z(),
                q.x(), q.y(), q.z(), q.w(), overlap, found.rms, end - begin);
  constexpr double kLeastOverlap = 0.2;
  return found.converged && overlap > kLeastOverlap ? 0 : kExitFailed;
}

}  // namespace adit::sim::perctool

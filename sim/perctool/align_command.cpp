// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <nlohmann/json.hpp>

#include "perception/odometry/align.hpp"
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
  const perception::VoxelPlanes planes = perception::align_target(*target);
  const double prepared = navtool::cpu_ms();
  const perception::Alignment found = perception::align(planes, *source, options.guess);
  const double end = navtool::cpu_ms();
  const Eigen::Vector3d& t = found.pose.position;
  const Eigen::Quaterniond& q = found.pose.orientation;
  const nlohmann::ordered_json out{{"pose", {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}},
                                   {"overlap", found.overlap},
                                   {"rmse", found.rmse},
                                   {"align_ms", end - prepared},
                                   {"total_ms", end - begin}};
  if (options.json)
    std::printf("%s\n", out.dump().c_str());
  else
    std::printf("%.4f %.4f %.4f %.6f %.6f %.6f %.6f, overlap %.2f, %.3f m, %.1f ms\n", t.x(), t.y(), t.z(),
                q.x(), q.y(), q.z(), q.w(), found.overlap, found.rmse, end - begin);
  constexpr double kLeastOverlap = 0.2;
  return found.converged && found.overlap > kLeastOverlap ? 0 : kExitFailed;
}

}  // namespace adit::sim::perctool

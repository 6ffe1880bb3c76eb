// SPDX-License-Identifier: Apache-2.0
// exploration_truth: what share of a world a recorded run saw, by the yardstick of rehearsals.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/config/platform_file.hpp"
#include "core/config/usage.hpp"
#include "sim/rehearsal/program/report_error.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "sim/truth/exploration_record.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

struct Options {
  std::string poses{}, world{}, platform{"wheeled"};
  double height{0};      ///< Of the lidar, m; 0: the platform's.
  bool of_lidar{false};  ///< The poses are the lidar's, not base_link's.
  bool json{false};
  int unseen{0};  ///< So many of the largest patches that were not seen are listed.
};

struct Recorded {
  std::vector<double> times{};
  std::vector<Pose3> poses{};
};

/// Reads poses: lines of "time x y z qx qy qz qw", with the times in rising order.
Result<Recorded> read_poses(const std::string& file) {
  std::ifstream in(file);
  if (!in) return Error{Reason::cannot_read, file + ": cannot be read"};
  Recorded out;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    double t = 0;
    Pose3 pose;
    Eigen::Quaterniond& q = pose.orientation;
    if (!(words >> t >> pose.position.x() >> pose.position.y() >> pose.position.z() >> q.x() >> q.y() >>
          q.z() >> q.w()) ||
        !std::isfinite(t) || !pose.position.allFinite() || !(std::fabs(q.norm() - 1) < 1e-3))
      return Error{Reason::syntax, file + ":" + std::to_string(number) +
                                       ": expected \"time x y z qx qy qz qw\" with a unit quaternion"};
    q.normalize();
    if (!out.times.empty() && t <= out.times.back())
      return Error{Reason::syntax,
                   file + ":" + std::to_string(number) + ": its time is not after the one before"};
    out.times.push_back(t);
    out.poses.push_back(pose);
  }
  if (out.poses.empty()) return Error{Reason::syntax, file + ": has no poses"};
  return out;
}

/// The patches to be listed.
std::vector<UnseenPatch> largest(const Options& options, const ExplorationTruth& truth) {
  if (options.unseen == 0) return {};
  std::vector<UnseenPatch> patches = truth.unseen();
  patches.resize(std::min(patches.size(), static_cast<std::size_t>(options.unseen)));
  return patches;
}

void print(const Options& options, const ExplorationTruth& truth, const ExplorationResult& result) {
  if (options.json) {
    nlohmann::ordered_json out{{"possible", truth.possible()},
                               {"share", result.share},
                               {"volume", result.volume},
                               {"metres", result.metres},
                               {"repeat", result.repeat}};
    for (const UnseenPatch& patch : largest(options, truth)) {
      const Eigen::Vector3d &a = patch.box.min(), &b = patch.box.max();
      out["unseen"].push_back({{"cells", patch.cells},
                               {"box", {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}},
                               {"places", patch.places}});
    }
    for (std::size_t n = 0; n < result.reached.size(); ++n) {
      const std::string key = ExplorationResult::name(n);
      if (result.reached[n])
        out[key] = {{"s", result.reached[n]->time_s}, {"m", result.reached[n]->metres}};
      else
        out[key] = nullptr;
    }
    std::printf("%s\n", out.dump().c_str());
    return;
  }
  std::printf("%zu cells of 0.5 m can be seen; seen %.2f %% over %.1f m, %.1f %% of it driven again;",
              truth.possible(), 100 * result.share, result.metres, 100 * result.repeat);
  for (std::size_t n = 0; n < result.reached.size(); ++n) {
    const auto& reached = result.reached[n];
    const double share = 100 * ExplorationResult::kShares[n];
    if (reached)
      std::printf(" %.0f %% at %.1f s, %.1f m;", share, reached->time_s, reached->metres);
    else
      std::printf(" %.0f %% never;", share);
  }
  std::printf("\n");
  for (const UnseenPatch& patch : largest(options, truth)) {
    const Eigen::Vector3d &a = patch.box.min(), &b = patch.box.max();
    std::printf("not seen: %zu cells, x %.1f to %.1f, y %.1f to %.1f, z %.1f to %.1f, from up to %d places\n",
                patch.cells, a.x(), b.x(), a.y(), b.y(), a.z(), b.z(), patch.places);
  }
}

int run(const Options& options) {
  auto platform = config::load_platform(options.platform);
  if (!platform) return report_error("exploration_truth", platform.error());
  if (options.height > 0) {
    platform->lidar_height = options.height;
    if (!platform->lidars.empty()) platform->lidars.front().mounting.z = options.height;
  }
  auto spec = load_world_spec(options.world);
  if (!spec) return report_error("exploration_truth", spec.error());
  auto world = make_world(*spec);
  if (!world) return report_error("exploration_truth", world.error());
  auto recorded = read_poses(options.poses);
  if (!recorded) return report_error("exploration_truth", recorded.error());
  if (options.of_lidar)
    for (Pose3& pose : recorded->poses) pose.position -= pose.orientation * platform->lidar_origin();
  const ExplorationRobot robot{*platform, recorded->poses.front().planar()};
  auto truth = ExplorationTruth::create(*world, std::span(&robot, 1));
  if (!truth) return report_error("exploration_truth", truth.error());
  ExplorationRecord record(std::move(*truth), 1);
  for (std::size_t n = 0; n < recorded->poses.size(); ++n)
    record.add(recorded->times[n], std::span(&recorded->poses[n], 1));
  print(options, record.truth(), record.result());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"What share of a world a recorded run saw.", "exploration_truth"};
  Options options;
  app.add_option("poses", options.poses, "TUM file, about five poses of base_link a second")->required();
  app.add_option("world", options.world, "scenario, or a file with what stands under its key `world`")
      ->required();
  app.add_option("--platform", options.platform, "its name, or a YAML file")->capture_default_str();
  app.add_option("--lidar-height", options.height, "m above the ground, instead of the platform's")
      ->check(config::between(0.05, 5.0));
  app.add_flag("--of-lidar", options.of_lidar, "the poses are the lidar's");
  app.add_option("--unseen", options.unseen, "also list so many patches that were not seen, largest first")
      ->check(config::between(0, 100'000));
  app.add_flag("--json", options.json, "one JSON object");
  app.footer(
      "A cell of 0.5 m counts once a ray of the lidar passed it within 12 m. 100 % is what can be seen from\n"
      "all places to which the platform can drive from the first pose.\n"
      "Example: exploration_truth run/r1_truth.tum config/scenarios/explore_blocks.yaml\n"
      "Exit status: 0 done, 2 wrong usage or unreadable input.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return config::end_usage(app, error);
  }
  return run(options);
}

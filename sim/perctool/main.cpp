// SPDX-License-Identifier: Apache-2.0
// perctool: perception without a robot, over recorded clouds, maps and trajectories.
#include <CLI/CLI.hpp>

#include "core/config/usage.hpp"
#include "sim/perctool/commands.hpp"

int main(int argc, char** argv) {
  using namespace adit::sim::perctool;
  CLI::App app{"Perception without a robot.", "perctool"};
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  perctool odometry --clouds street/ --out street.tum --json\n"
      "  perctool map --clouds street/ --poses street.tum --out street.bt\n"
      "  perctool align target.pcd source.pcd --json\n"
      "  perctool record tunnel.yaml --robot r1 --out r1.mcap\n"
      "  perctool eval truth.tum estimate.tum --align --json\n"
      "  perctool diff a.bt b.bt --json\n"
      "Exit status: 0 done, 1 it did not converge or was lost, 2 wrong usage or unreadable input.");

  EvalOptions eval_options;
  CLI::App* evals =
      app.add_subcommand("eval", "absolute and relative errors of a trajectory, as evo has them");
  evals->footer(
      "Both files are TUM: stamp x y z qx qy qz qw. Each pose of the shorter one belongs to the one of the "
      "other that is\nnearest in time. ATE is what `evo_ape tum` prints, RPE what `evo_rpe tum` prints (m; "
      "rpe_deg: -r angle_deg).\n"
      "Example: perctool eval truth.tum estimate.tum --align --delta 10 --unit m --json");
  evals->add_option("TRUTH", eval_options.truth, "TUM file")->required();
  evals->add_option("ESTIMATE", eval_options.estimate, "TUM file")->required();
  evals->add_flag("--align", eval_options.align, "move the estimate onto the truth first (Umeyama, SE(3))");
  evals->add_option("--max-diff", eval_options.max_diff, "of stamps that belong together, s")
      ->capture_default_str()
      ->check(adit::config::between(1e-9, 10.0));
  evals->add_option("--delta", eval_options.delta, "between the two poses of a relative error")
      ->capture_default_str()
      ->check(adit::config::between(1e-3, 1e6));
  evals->add_option("--unit", eval_options.unit, "of --delta: f (poses) or m")
      ->capture_default_str()
      ->check(CLI::IsMember({"f", "m"}));
  evals->add_flag("--json", eval_options.json, "one JSON object");

  OdometryOptions odometry_options;
  CLI::App* odometries = app.add_subcommand("odometry", "trajectory from clouds, IMU and wheels");
  odometries->footer(
      "Clouds are .pcd, .ply or KITTI's .bin, one a sweep, in name order, 1 / RATE s apart; or an MCAP file "
      "of "
      "`perctool\nrecord`, which has IMU, wheels and sensors in it. The IMU's CSV has the columns "
      "stamp_s,gx,gy,gz,ax,ay,az (rad/s,\nm/s2; s since the first cloud), with or without a line of "
      "headings; "
      "wheels are TUM. One TUM line a sweep: poses of\nbase_link (of the lidar without --sensor) in the "
      "first "
      "one's frame.\n"
      "With --json one line a sweep, {\"sweep\":0,\"ms\":..,\"health\":\"ok\",..}, and a last one with "
      "medians; "
      "ms is the thread's\nCPU time without reading.\n"
      "Example: perctool odometry --clouds street/ --sensor hdl64.yaml --out street.tum --json");
  odometries->add_option("--clouds", odometry_options.log.clouds, "file, folder, or MCAP file")->required();
  odometries->add_option("--rate", odometry_options.log.rate, "clouds a second, Hz")
      ->capture_default_str()
      ->check(adit::config::between(0.1, 100.0));
  odometries->add_option("--sensor", odometry_options.sensor,
                         "YAML file with the sensors: part of a platform's");
  odometries->add_option("--imu", odometry_options.log.imu, "CSV file");
  odometries->add_option("--wheels", odometry_options.log.wheels, "TUM file");
  odometries->add_option("--out", odometry_options.out, "TUM file to write")->required();
  odometries->add_option("--truth", odometry_options.truth, "TUM file to write: true poses of an MCAP file");
  odometries->add_flag("--json", odometry_options.json, "one JSON line a sweep");

  MapOptions map_options;
  CLI::App* maps = app.add_subcommand("map", "map from clouds and poses");
  maps->footer(
      "Example: perctool map --clouds street/ --poses street.tum --resolution 0.1 --out street.bt --json");
  maps->add_option("--clouds", map_options.clouds, "file, or folder of files")->required();
  maps->add_option("--poses", map_options.poses,
                   "of base_link (of the lidar without --sensor), TUM, one a cloud")
      ->required();
  maps->add_option("--sensor", map_options.sensor, "YAML file with the sensors: part of a platform's");
  maps->add_option("--resolution", map_options.resolution, "edge of a voxel, m")
      ->capture_default_str()
      ->check(adit::config::between(0.01, 1.0));
  maps->add_option("--range", map_options.range, "of each cloud, m")
      ->capture_default_str()
      ->check(adit::config::between(0.5, 200.0));
  maps->add_option("--out", map_options.out, ".bt, .ot, .pcd or .ply file to write")->required();
  maps->add_flag("--json", map_options.json, "one JSON line a sweep");

  AlignOptions align_options;
  std::vector<double> guess;
  CLI::App* aligns = app.add_subcommand("align", "pose of one cloud in another one's frame");
  aligns->footer(
      "{\"pose\":[x,y,z,qx,qy,qz,qw],\"overlap\":..,\"rmse\":..,\"align_ms\":..,\"total_ms\":..}\n"
      "Example: perctool align target.ply source.ply --guess 0 0 0 0 0 0 1 --json");
  aligns->add_option("TARGET", align_options.target, "cloud")->required();
  aligns->add_option("SOURCE", align_options.source, "cloud")->required();
  aligns->add_option("--guess", guess, "x y z qx qy qz qw")
      ->expected(7)
      ->delimiter(' ')
      ->check(adit::config::between(-1e6, 1e6));
  aligns->add_flag("--json", align_options.json, "one JSON object");

  StairsOptions stairs_options;
  CLI::App* stairs_command =
      app.add_subcommand("stairs", "staircases in clouds: one line each, none when there is none");
  stairs_command->footer(
      "Clouds are in base_link: level, the ground under the robot near z = 0. foot and top are the centres "
      "of the "
      "lowest\nand the highest riser; heading points upwards, rad.\n"
      "Example: perctool stairs scan.pcd --json\n"
      "Example: perctool stairs climb/ --poses climb.tum --json");
  stairs_command->add_option("CLOUDS", stairs_options.clouds, "file, or folder of files")->required();
  stairs_command->add_option("--poses", stairs_options.poses,
                             "of base_link, TUM, one a cloud: the clouds of 1.5 s are accumulated");
  CLI::Option* sensor = stairs_command->add_option("--sensor", stairs_options.sensor,
                                                   "YAML file with the sensors: part of a platform's");
  stairs_command->add_option("--lidar-height", stairs_options.eye, "above the ground, m")
      ->capture_default_str()
      ->excludes(sensor)
      ->check(adit::config::between(0.0, 10.0));
  stairs_command->add_flag("--json", stairs_options.json, "one JSON object a staircase");

  RecordOptions record_options;
  std::uint64_t seed = 0;
  CLI::App* records =
      app.add_subcommand("record", "raw sensors and truth of a robot in a rehearsal, as MCAP");
  records->footer("Example: perctool record tunnel.yaml --robot r1 --out r1.mcap");
  records->add_option("SCENARIO", record_options.scenario, "scenario file")->required();
  records->add_option("--robot", record_options.robot, "its id")->required();
  records->add_option("--out", record_options.out, "MCAP file to write")->required();
  CLI::Option* seed_option = records->add_option("--seed", seed, "else the scenario's")
                                 ->check(adit::config::between(std::uint64_t{0}));

  DiffOptions diff_options;
  CLI::App* diffs = app.add_subcommand("diff", "cells of two OctoMap files that are equal, missing, more");
  diffs->footer(
      "Counted are cells of the maps' resolution; a pruned leaf counts as all of its cells. missing: known "
      "in A "
      "alone;\nmore: known in B alone; different: free in the one, occupied in the other.\n"
      "Example: perctool diff a.bt b.bt --json");
  diffs->add_option("A", diff_options.a, ".bt or .ot")->required();
  diffs->add_option("B", diff_options.b, ".bt or .ot")->required();
  diffs->add_flag("--json", diff_options.json, "one JSON object");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return adit::config::end_usage(app, error);
  }
  if (*evals) return eval(eval_options);
  if (*odometries) return odometry(odometry_options);
  if (*maps) return map(map_options);
  if (*stairs_command) return stairs(stairs_options);
  if (*aligns) {
    if (guess.size() == 7) {
      const Eigen::Quaterniond turn(guess[6], guess[3], guess[4], guess[5]);
      if (!(turn.norm() > 0.5 && turn.norm() < 2.0)) {
        std::fprintf(stderr, "perctool: --guess: expected a unit quaternion\n");
        return 2;
      }
      align_options.guess = {{guess[0], guess[1], guess[2]}, turn.normalized()};
    }
    return align(align_options);
  }
  if (*records) {
    if (seed_option->count() > 0) record_options.seed = seed;
    return record(record_options);
  }
  return diff(diff_options);
}

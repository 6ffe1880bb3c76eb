// SPDX-License-Identifier: Apache-2.0
// Controllers: a solve of iterative LQR (horizon 50) per motion model beside the same problem in Ceres, and a
// whole step of each controller; then how far each strays from the same paths. Goals: below 300 us a solve,
// less than half of pure pursuit's error.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "nav/control/controller.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/ceres_problem.hpp"
#include "tests/nav/wave.hpp"

namespace adit::nav {
namespace {

using test::Bench;
using test::kWaveDt;

template <class Model>
std::array<Reference, Ilqr<Model>::kHorizon> ahead(double t) {
  std::array<Reference, Ilqr<Model>::kHorizon> references;
  for (std::size_t k = 0; k < references.size(); ++k)
    references[k] = test::wave(t + kWaveDt * static_cast<double>(k + 1), 0.7);
  return references;
}

template <class Model>
typename Ilqr<Model>::X beside_the_wave() {
  typename Ilqr<Model>::X x;
  x.template head<3>() << 0.0, 0.1, 0.5;
  x.template tail<Model::kVelocities>() = Bench<Model>::model().inverse({0.5, 0, 0});
  return x;
}

/// As a controller does it: step after step along the wave, pushed aside by 3 cm once a second.
template <class Model>
void solve(benchmark::State& state) {
  Ilqr<Model> solver(Bench<Model>::model(), Bench<Model>::limits(), {}, kWaveDt);
  auto x = beside_the_wave<Model>();
  int step = 0;
  double iterations = 0;
  for (auto _ : state) {
    iterations += solver.solve(x, ahead<Model>(kWaveDt * step)).iterations;
    x = solver.state(1);
    if (++step % 20 == 0) x[1] += 0.03;
    if (step == 400) {
      step = 0;
      x = beside_the_wave<Model>();
    }
  }
  state.counters["iterations"] = iterations / static_cast<double>(state.iterations());
}

template <class Model>
void ceres_solve(benchmark::State& state) {
  test::CeresProblem<Model> problem({Bench<Model>::model(), Bench<Model>::limits(), {}, kWaveDt},
                                    beside_the_wave<Model>(), ahead<Model>(0));
  for (auto _ : state) benchmark::DoNotOptimize(problem.solve());
}

/// A path of 3.5 m whose curvature swings: `bend` (1/m) at most, `waves` to and fro.
Plan path(double bend, double waves, double speed) {
  Plan plan;
  plan.max_speed = speed;
  plan.pose_count = 71;
  plan.length = 3.5;
  Pose2 at{};
  for (std::uint32_t i = 0; i < plan.pose_count; ++i) {
    plan.poses[i] = at;
    at = at * Pose2{0.05, 0, 0.05 * bend * std::sin(2 * M_PI * waves * i / 70.0)};
  }
  return plan;
}

/// Root mean square distance from the path, mm, over paths of several shapes, with an offset at the start.
double error_mm(const std::string& name, const Platform& platform) {
  double sum = 0;
  int count = 0;
  for (const double bend : {0.5, 1.0, 2.0})
    for (const double waves : {0.5, 1.0, 1.5}) {
      const auto controller = make_controller(name, platform).value();
      const Plan plan = path(bend, waves, platform.max_speed);
      controller->set_plan(plan);
      Pose2 robot{0, 0.05, 0};
      for (int i = 0; i < 300; ++i) {
        const Twist2 v = controller->follow(robot, kWaveDt);
        for (int n = 0; n < 10; ++n)
          robot = robot * Pose2{0.1 * v.vx * kWaveDt, 0.1 * v.vy * kWaveDt, 0.1 * v.wz * kWaveDt};
        double best = 1e9;
        for (std::size_t k = 0; k + 1 < plan.pose_count; ++k) {
          const Eigen::Vector2d a = plan.poses[k].position(), b = plan.poses[k + 1].position();
          const double u = std::clamp((robot.position() - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
          best = std::min(best, (robot.position() - a - u * (b - a)).squaredNorm());
        }
        sum += best;
        ++count;
        if ((robot.position() - plan.poses[70].position()).norm() < 0.2) break;
      }
    }
  return 1000 * std::sqrt(sum / count);
}

void step(benchmark::State& state, const std::string& name, const Platform& platform) {
  const auto controller = make_controller(name, platform).value();
  const Plan plan = path(1.0, 1.0, platform.max_speed);
  Pose2 robot{0, 0.05, 0};
  for (auto _ : state) {
    controller->set_plan(plan);
    const Twist2 v = controller->follow(robot, kWaveDt);
    robot = robot * Pose2{v.vx * kWaveDt, v.vy * kWaveDt, v.wz * kWaveDt};
    if ((robot.position() - plan.poses[70].position()).norm() < 0.3) robot = {0, 0.05, 0};
  }
  state.counters["error_mm"] = error_mm(name, platform);
}

#define ADIT_MODELS(function)                                          \
  BENCHMARK(function<model::Unicycle>)->Unit(benchmark::kMicrosecond); \
  BENCHMARK(function<model::Car>)->Unit(benchmark::kMicrosecond);      \
  BENCHMARK(function<model::Holonomic>)->Unit(benchmark::kMicrosecond)
ADIT_MODELS(solve);
ADIT_MODELS(ceres_solve);

BENCHMARK_CAPTURE(step, ilqr_wheeled, "ilqr", test::wheeled())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, pure_pursuit_wheeled, "pure_pursuit", test::wheeled())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, ilqr_tracked, "ilqr", test::tracked())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, pure_pursuit_tracked, "pure_pursuit", test::tracked())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, ilqr_legged, "ilqr", test::legged())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, pure_pursuit_legged, "pure_pursuit", test::legged())->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace adit::nav

BENCHMARK_MAIN();

// SPDX-License-Identifier: Apache-2.0
// A mode that costs one module, one row and one line of the tree: `orbit`, the example of
// docs/adding_a_mode.md.
#include "examples/02_mode_orbit.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/store/memory_disk.hpp"
#include "robot_agent/behaviour/decider.hpp"
#include "tests/agent/agent_bench.hpp"
#include "tests/folders/folders.hpp"

namespace adit::agent {
namespace {

using namespace radio;  // the command kinds
using testing::Contains;

/// The shipped tree and one line.
std::string write_tree() {
  std::ifstream shipped(source_folder() + "/config/trees/robot.xml");
  std::stringstream text;
  text << shipped.rdbuf();
  const std::string file = scratch_folder() + "/orbit.xml";
  std::ofstream(file) << with_orbit(text.str());
  return file;
}

class Orbit : public testing::Test {
 protected:
  Orbit() {
    op.emplace(&bench.join("op1"));
    bench.run(2s);
  }

  AgentBench::Operator& station() { return **op; }
  double radius() const { return (Eigen::Vector2d(bench.pose.x, bench.pose.y) - kCentre).norm(); }
  double angle() const { return std::atan2(bench.pose.y - kCentre.y(), bench.pose.x - kCentre.x()); }
  /// The angle driven around the centre, rad; meanwhile the robot stays on the circle.
  double drive(Duration time) {
    double driven = 0.0;
    for (Duration t{}; t < time; t += 500ms) {
      const double before = angle();
      bench.run(500ms);
      driven += wrap_angle(angle() - before);
      EXPECT_NEAR(radius(), OrbitMode::kRadius, 1.0);
    }
    return driven;
  }

  static inline const Eigen::Vector2d kCentre{0.0, OrbitMode::kRadius};  // the robot starts at the origin
  const std::string tree = write_tree();
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  AgentBench bench{[this] {
                     AgentParams params{};
                     params.modes = modes_with_orbit();
                     params.disk = disk;
                     return params;
                   }(),
                   1, tree};
  std::optional<AgentBench::Operator*> op{};
};

TEST_F(Orbit, IsAModeLikeAnyOther) {
  EXPECT_THAT(station().behaviour.modes(),
              Contains(testing::Property(&radio::ModeOption::mode, testing::Eq("orbit"))));
  EXPECT_THAT(station().capabilities.modes(), Contains("orbit"));
  ASSERT_EQ(bench.ask(station(), CMD_TAKE), Reason::none);
  bench.obstacles.push_back({0.0f, 3.0f, 0.5f});
  bench.run(1s);
  EXPECT_EQ(bench.ask(station(), CMD_MODE, "orbit"), Reason::goal_unreachable) << "its own condition";
}

TEST_F(Orbit, DrivesAroundAPoint) {
  ASSERT_EQ(bench.ask(station(), CMD_TAKE), Reason::none);
  ASSERT_EQ(bench.ask(station(), CMD_MODE, "orbit"), Reason::none);
  EXPECT_GT(drive(60s), 2 * std::numbers::pi);
  ASSERT_EQ(bench.ask(station(), CMD_STOP), Reason::none);
  bench.run(1s);
  EXPECT_EQ(drive(2s), 0.0) << "a stop is enforced for every mode";
  ASSERT_EQ(bench.ask(station(), CMD_RESET), Reason::none);
  EXPECT_EQ(drive(2s), 0.0);
  ASSERT_EQ(bench.ask(station(), CMD_MODE, "orbit"), Reason::none);
  EXPECT_GT(drive(20s), 1.0) << "around the same point";
}

TEST_F(Orbit, GoesOnAfterARestart) {
  ASSERT_EQ(bench.ask(station(), CMD_TAKE), Reason::none);
  ASSERT_EQ(bench.ask(station(), CMD_MODE, "orbit"), Reason::none);
  EXPECT_GT(drive(20s), 1.0);
  bench.stop_agent();
  bench.command = {};
  bench.run(500ms);
  bench.start_agent();
  bench.run(5s);
  EXPECT_GT(drive(20s), 1.0) << "around the same point";
}

TEST_F(Orbit, ATreeThatSkipsItsConditionsIsRefused) {
  std::ifstream file(tree);
  std::stringstream text;
  text << file.rdbuf();
  std::string xml = text.str();
  const std::string leaf = "<Mode mode=\"orbit\"/>";
  xml.replace(xml.find(leaf), leaf.size(),
              "<ReactiveSequence><Requested mode=\"orbit\"/><NotStopped/><DriverAlive/><Localised/>"
              "<Run mode=\"orbit\"/></ReactiveSequence>");
  const auto modes = modes_with_orbit();
  const auto decider = Decider::load_text(xml, *modes);
  ASSERT_FALSE(decider);
  EXPECT_THAT(decider.error().text,
              testing::HasSubstr("Run mode=\"orbit\" lacks the condition TerrainFresh"));
}

}  // namespace
}  // namespace adit::agent

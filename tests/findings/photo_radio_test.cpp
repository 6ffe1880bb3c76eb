// SPDX-License-Identifier: Apache-2.0
// A report of a program on the robot and an operator's mark, each with a photo, on a thin link that loses, is
// cut, and between restarts of robot and station. Robot, stations and wire are those of the product.
#include <gmock/gmock.h>

#include <fstream>
#include <iostream>

#include "basestation/station/station.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/agent.hpp"
#include "tests/findings/drawn_photo.hpp"
#include "tests/folders/folders.hpp"
#include "visualization_msgs/msg/Marker.h"

namespace adit {
namespace {

using namespace std::chrono_literals;
using visualization_msgs::msg::Marker;

/// One robot with its driver and a program that reports, and two stations.
class PhotoRadioTest : public testing::Test {
 protected:
  struct Op {
    std::string name{};
    std::unique_ptr<Runtime> machine{};
    std::shared_ptr<Executor> strand{};
    std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
    std::unique_ptr<wire::Participant> wire{};
    std::unique_ptr<station::Station> station{};
    std::uint64_t starts{};
  };
  PhotoRadioTest() {
    network.set_link("r1", "driver", {});
    driver_wire = network.join(100, "driver");
    odom = wire::Writer<nav_msgs::msg::Odometry>::make(*driver_wire, wire::topics::kOdom).value();
    reports = wire::Writer<Marker>::make(*driver_wire, wire::topics::kReports).value();
    odom_timer = driver_strand->every(50ms, [this] {
      nav_msgs::msg::Odometry message;
      stamp(message.header());
      message.pose().pose().orientation().w(1.0);
      (void)odom.write(message);
    });
    start_robot();
    for (std::size_t i = 0; i < ops.size(); ++i) {
      ops[i].name = "op" + std::to_string(i + 1);
      ops[i].machine = scheduler.machine(ops[i].name, 5s);
      ops[i].strand = ops[i].machine->strand("station");
      start(ops[i]);
    }
    run(20s);
  }
  ~PhotoRadioTest() override {
    robot.reset();
    for (Op& op : ops) op.station.reset();
  }
  void stamp(std_msgs::msg::Header& header) const {
    const auto ns = driver_strand->now().time_since_epoch().count();
    header.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    header.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  void start_robot() {
    robot_radio = network.join(77, "r1");
    robot_inner = network.join(100, "r1");
    params.tree = source_folder() + "/config/trees/robot.xml";
    params.disk = robot_disk;
    ++params.seed;
    robot = std::make_unique<agent::Agent>(params, *robot_machine, *robot_radio, *robot_inner);
    ASSERT_TRUE(robot->start().ok());
  }
  void restart_robot() {
    network.crash("r1");
    robot.reset();
    robot_radio.reset();
    robot_inner.reset();
    run(2s);
    start_robot();
  }
  void start(Op& op) {
    op.wire = network.join(77, op.name);
    station::StationParams station_params;
    station_params.name = op.name;
    station_params.id = {static_cast<std::uint8_t>(op.name.back())};
    station_params.seed = ++op.starts * 100 + static_cast<std::uint8_t>(op.name.back());
    station_params.disk = op.disk;
    op.station = std::make_unique<station::Station>(station_params, *op.strand, *op.wire);
    ASSERT_TRUE(op.station->start().ok());
  }
  void restart(Op& op) {
    network.crash(op.name);
    op.station.reset();
    op.wire.reset();
    run(2s);
    start(op);
  }
  void run(Duration span) { scheduler.run_until(scheduler.elapsed() + span); }
  station::Outcome execute(Op& op, const std::string& line) {
    auto ended = std::make_shared<std::optional<station::Outcome>>();
    op.strand->post([&op, line, ended] {
      op.station->execute(line, [ended](const station::Outcome& outcome) { *ended = outcome; });
    });
    for (int i = 0; i < 600 && !*ended; ++i) run(10ms);
    return ended->value_or(station::Outcome{.exit_code = -1});
  }
  /// "none", "thumbnail" or "whole" of the first finding of that kind; "-": there is none.
  nlohmann::json photo_of(Op& op, const std::string& kind) {
    const auto rows = execute(op, "findings").json["findings"];
    for (const auto& row : rows)
      if (row["kind"] == kind && row.contains("photo")) return row["photo"];
    return {{"here", "-"}, {"percent", 0}};
  }
  /// Seconds until a part is there; 1000: never.
  double until(Op& op, const std::string& kind, const std::string& part, int percent = 0) {
    const Duration begin = scheduler.elapsed();
    while (scheduler.elapsed() - begin < 1000s) {
      const auto photo = photo_of(op, kind);
      if (photo["here"] == "whole") break;
      if (part == "thumbnail" && photo["here"] == part && photo["percent"] >= percent) break;
      run(100ms);
    }
    return seconds(scheduler.elapsed() - begin);
  }
  void report(const store::Bytes& jpeg) {
    Marker marker;
    stamp(marker.header());
    marker.header().frame_id("base_link");
    marker.ns("person");
    marker.id(1);
    marker.text("under the beam");
    marker.pose().position().x(3.0);
    marker.texture().data() = jpeg;
    ASSERT_TRUE(reports.write(marker));
  }
  void cut(bool is_cut) {
    for (const Op& op : ops) network.cut("r1", op.name, is_cut);
  }

  VirtualScheduler scheduler{3};
  wire::SimulatedNetwork network{
      scheduler,
      {.seed = 3, .link = {.name = "mesh_100k", .bandwidth = 100e3, .latency = 0.15, .loss = 0.1}}};
  std::unique_ptr<Runtime> robot_machine{scheduler.machine("r1", 77777s)},
      driver{scheduler.machine("driver", 9s)};
  std::shared_ptr<Executor> driver_strand{driver->strand("driver")};
  std::shared_ptr<store::MemoryDisk> robot_disk{std::make_shared<store::MemoryDisk>()};
  agent::AgentParams params{};
  std::unique_ptr<wire::Participant> driver_wire{}, robot_radio{}, robot_inner{};
  wire::Writer<nav_msgs::msg::Odometry> odom{};
  wire::Writer<Marker> reports{};
  Timer odom_timer{};
  std::unique_ptr<agent::Agent> robot{};
  std::array<Op, 2> ops{};
};

TEST_F(PhotoRadioTest, AReportAndAMarkArriveWithTheirPhotosOverAThinLink) {
  const std::string folder = scratch_folder();
  const store::Bytes seen = findings::drawn_photo(240, 5).picture,
                     marked = findings::drawn_photo(80, 6).picture;
  const std::string file = folder + "/mark.jpg";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(marked.data()), static_cast<std::streamsize>(marked.size()));
  report(seen);
  ASSERT_EQ(execute(ops[0], "finding add gas 1 2 0 smells --photo " + file).exit_code, 0);
  const double thumbnail = until(ops[0], "person", "thumbnail"), other = until(ops[1], "gas", "thumbnail");
  EXPECT_LT(thumbnail, 10.0);
  EXPECT_LT(other, 15.0);
  const double quarter = until(ops[0], "person", "thumbnail", 25);
  cut(true);
  run(30s);
  const int percent = photo_of(ops[0], "person")["percent"];
  EXPECT_LT(percent, 90) << "the link was cut";
  cut(false);
  restart_robot();
  restart(ops[0]);
  run(2s);
  EXPECT_GE(photo_of(ops[0], "person")["percent"], percent) << "what was there is still there";
  const double whole = until(ops[0], "person", "whole"), whole_at_2 = until(ops[1], "person", "whole"),
               mark_at_2 = until(ops[1], "gas", "whole");
  EXPECT_LT(whole, 120.0);
  std::cout << "mesh_100k, report with a photo of " << seen.size() / 1024 << " kB and mark with one of "
            << marked.size() / 1024 << " kB: thumbnail of the report after " << thumbnail
            << " s, of the mark " << other << " s later; 25 % of the photo " << quarter
            << " s later; then 30 s without a link and a "
            << "restart of robot and station; whole photo at op1 " << whole << " s after that, at op2 "
            << whole_at_2 << " s later, of the mark at op2 " << mark_at_2 << " s later\n";
  for (Op& op : ops) {
    const std::string out = folder + "/" + op.name + ".jpg";
    const auto written = execute(op, "finding photo 1 " + out);
    EXPECT_EQ(written.exit_code, 0) << written.error;
    EXPECT_EQ(written.json["whole"], true);
    std::ifstream in(out, std::ios::binary);
    const store::Bytes bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_TRUE(bytes == seen || bytes == marked) << op.name;
  }
}

}  // namespace
}  // namespace adit

// SPDX-License-Identifier: Apache-2.0
// The component that turns what sensors send into scans and poses, alone, on virtual time.
#include "robot_agent/motion/scans.hpp"

#include <gmock/gmock.h>

#include <map>

#include "core/exec/virtual_runtime.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tests/point_cloud.hpp"

namespace adit::agent {
namespace {

using testing::Contains;
using testing::Not;

constexpr std::uint64_t kMillisecond = 1'000'000;
constexpr std::uint64_t kFirstStamp = 100'000 * kMillisecond;

/// Keeps what the component passes on.
class Taker : public Component {
 public:
  Taker(Executor& strand, ScanService& service) : Component("taker", strand, Log{}), service_(service) {}
  std::vector<LidarScan> scans{};

 private:
  Result<void> on_start() override {
    offer(service_, [this](const LidarScan& scan, const Reply<void>& reply) {
      scans.push_back(scan);
      reply({});
    });
    return {};
  }
  ScanService& service_;
};

/// A robot that drives a circle in a room; its lidar sees 16 rings of 360 points in 0.1 s.
class ScansTest : public testing::Test {
 protected:
  static constexpr double kSpeed = 1.0, kTurn = 0.5;  ///< Of the body, m/s and rad/s.
  static constexpr double kLidar = 0.5;               ///< Above base_link, m.

  void SetUp() override {
    ASSERT_TRUE(taker_.start().ok());
    ASSERT_TRUE(scans_.start().ok());
  }
  void TearDown() override {
    scans_.stop();
    taker_.stop();
  }
  static Pose3 truth(double t) {
    const double yaw = kTurn * t, r = kSpeed / kTurn;
    return Pose3::level({r * std::sin(yaw), r * (1 - std::cos(yaw)), yaw}, 0);
  }
  /// Distance from `from` along `ray` to the room: 14 m x 10 m, 3 m high.
  static double distance(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    const Eigen::Vector3d low(-6, -4, 0), high(8, 6, 3);
    double nearest = 1e9;
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(ray[axis]) > 1e-9)
        nearest = std::min(nearest, ((ray[axis] > 0 ? high : low)[axis] - from[axis]) / ray[axis]);
    return nearest;
  }
  /// Points of the sweep that ends at `end` s, as measured while the body drove; without their times.
  static std::vector<Eigen::Vector3f> sweep(double end) {
    std::vector<Eigen::Vector3f> points;
    for (int column = 0; column < 360; ++column) {
      const Pose3 body = truth(end - 0.1 * (359 - column) / 359.0);
      const Eigen::Vector3d from = body * Eigen::Vector3d(0, 0, kLidar);
      for (int ring = 0; ring < 16; ++ring) {
        const double up = (ring - 7.5) * 2 * M_PI / 180, around = column * M_PI / 180;
        const Eigen::Vector3d ray(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around),
                                  std::sin(up));
        points.push_back((distance(from, body.orientation * ray) * ray).cast<float>());
      }
    }
    return points;
  }
  static void stamp(std_msgs::msg::Header& header, std::uint64_t at, const std::string& frame) {
    header.stamp().sec(static_cast<std::int32_t>(at / 1'000'000'000));
    header.stamp().nanosec(static_cast<std::uint32_t>(at % 1'000'000'000));
    header.frame_id(frame);
  }
  void send_odometry(double t, std::int64_t clock_ms = 0) {
    nav_msgs::msg::Odometry odometry;
    stamp(odometry.header(), at(t, clock_ms), "odom");
    const Pose3 pose = truth(t);
    odometry.pose().pose().position().x(pose.position.x());
    odometry.pose().pose().position().y(pose.position.y());
    odometry.pose().pose().orientation().z(pose.orientation.z());
    odometry.pose().pose().orientation().w(pose.orientation.w());
    odometry.twist().twist().linear().x(kSpeed);
    odometry.twist().twist().angular().z(kTurn);
    scans_.take(odometry, strand_->now());
  }
  void send_cloud(const std::vector<Eigen::Vector3f>& points, double t, std::int64_t clock_ms = 0,
                  std::size_t lidar = 0) {
    std::vector<float> numbers;
    for (const Eigen::Vector3f& p : points) numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
    auto cloud = cloud_of(numbers);
    stamp(cloud.header(), at(t, clock_ms), platform_.all_lidars()[lidar].frame);
    scans_.take(cloud, lidar, strand_->now());
  }
  static std::uint64_t at(double t, std::int64_t clock_ms) {
    return kFirstStamp + static_cast<std::uint64_t>(std::llround(t * 1e9) +
                                                    clock_ms * static_cast<std::int64_t>(kMillisecond));
  }
  void run_until(double t) {
    scheduler_.run_until(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(t)));
  }
  /// Drives from `from` to `to` s: odometry at 50 Hz, a cloud each 0.1 s that arrives `late` s after its end.
  template <class OnCloud>
  void drive(double from, double to, double late, const OnCloud& on_cloud) {
    const int first = static_cast<int>(std::lround(from * 50)), last = static_cast<int>(std::lround(to * 50));
    for (int n = first + 1; n <= last; ++n) {
      const double t = 0.02 * n;
      run_until(t);
      send_odometry(t, odometry_clock_);
      if (n % 5 == 0) on_cloud(t - late);
    }
    run_until(to + 0.01);
  }
  const OdometryReport* newest() const {
    for (auto scan = taker_.scans.rbegin(); scan != taker_.scans.rend(); ++scan)
      if (scan->odometry) return &*scan->odometry;
    return nullptr;
  }
  std::vector<std::string> codes() const {
    std::vector<std::string> all;
    for (const InputFault& fault : faults_) all.push_back(fault.code);
    return all;
  }

  static Platform robot() {
    Platform p;
    p.max_speed = 1.5;
    p.lidar_height = kLidar;
    return p;
  }
  explicit ScansTest(Platform platform = robot()) : platform_(std::move(platform)) {}

  std::int64_t odometry_clock_{0};  ///< Ahead of the lidar's, ms.
  Platform platform_;
  VirtualScheduler scheduler_{1};
  std::unique_ptr<Runtime> machine_{scheduler_.machine("r1", 5s)};
  std::shared_ptr<Strand> strand_{machine_->strand("sensors")};
  ScanService service_{"scans", 4};
  std::vector<InputFault> faults_{};
  Taker taker_{*strand_, service_};
  Scans scans_{
      *strand_, Log{}, platform_, service_, [this](const InputFault& fault) { faults_.push_back(fault); },
      {},       1};
};

TEST_F(ScansTest, CloudsWithoutTimesAreTakenForThoseThatMotionDistorts) {
  // The same clouds, and the odometry fed by hand; it begins with the first of them.
  perception::ScanInput input(platform_);
  input.mark_isolated(true);
  perception::LidarOdometry odometry(perception::LidarOdometryParams::of(platform_));
  int fed = 0;
  drive(0, 4, 0, [&](double t) {
    const auto points = sweep(t);
    send_cloud(points, t);
    for (; fed <= static_cast<int>(std::lround(t * 50)); ++fed)
      if (fed > 5) odometry.add(perception::BodyMotion{at(0.02 * fed, 0), truth(0.02 * fed)});
    if (!odometry.advance(at(t, 0))) return;
    perception::Sweep one;
    one.stamp = at(t, 0);
    for (const Eigen::Vector3f& p : points) one.points.push_back({p, 0.0f, 0.0f, 0});
    const auto scan =
        input.add(one, 0, platform_.lidar().frame, [&](std::uint64_t s) { return odometry.at(s); });
    ASSERT_TRUE(scan && *scan);
    odometry.update((*scan)->points, (*scan)->isolated, false);
  });
  const OdometryReport* report = newest();
  ASSERT_NE(report, nullptr);
  EXPECT_LT((report->T_local_base.position - odometry.state().pose.position).norm(), 1e-9);
}

TEST_F(ScansTest, AScanThatWasDelayedOnceIsNotOfAnotherClock) {
  drive(0, 2, 0, [&](double t) { send_cloud(sweep(t), t); });
  taker_.scans.clear();
  // A computer that was busy: one cloud comes 0.7 s late, and the odometry in time.
  drive(2, 2.7, 0, [](double) {});
  send_cloud(sweep(2), 2);
  run_until(2.72);
  const OdometryReport* report = newest();
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->stamp, at(2, 0));
  const Pose3 driver = truth(2);
  EXPECT_LT((report->T_local_driver * driver).position.x() - report->T_local_base.position.x(), 0.01);
  EXPECT_EQ(report->health, Localisation::ok);
}

TEST_F(ScansTest, AClockThatIsAlwaysApartIsReportedAndThePoseIsWeak) {
  odometry_clock_ = 5000;
  drive(0, 3, 0, [&](double t) { send_cloud(sweep(t), t); });
  const OdometryReport* report = newest();
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->health, Localisation::weak);
  EXPECT_THAT(codes(), Contains("not_deskewed"));
}

TEST_F(ScansTest, SweepsOfALidarWhoseClockIsAheadWaitForTheirPoses) {
  // Less than what is taken for another clock, but more than the time between two sweeps.
  odometry_clock_ = -150;
  drive(0, 3, 0, [&](double t) { send_cloud(sweep(t), t); });
  const OdometryReport* report = newest();
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->stamp, at(2.8, 0));
  // What was measured now is taken for what the odometry says of 0.15 s later.
  EXPECT_EQ(report->health, Localisation::weak);
  EXPECT_GT(report->sigma, 0.2);
}

TEST_F(ScansTest, OdometryThatStopsHoldsNoSweepBack) {
  odometry_clock_ = -150;
  drive(0, 2, 0, [&](double t) { send_cloud(sweep(t), t); });
  taker_.scans.clear();
  for (double t = 2.1; t < 4; t += 0.1) {
    run_until(t);
    send_cloud(sweep(t), t);
    if (t < 2.5) continue;
    ASSERT_FALSE(taker_.scans.empty()) << t;
    EXPECT_GT(taker_.scans.back().stamp, at(t - 0.45, 0)) << t;
  }
}

TEST_F(ScansTest, ALidarOf50HertzWhoseClockIsAheadIsWaitedForAsWell) {
  odometry_clock_ = -150;
  const auto one = sweep(0);
  for (int n = 1; n < 100; ++n) {
    run_until(0.02 * n);
    send_odometry(0.02 * n, odometry_clock_);
    send_cloud(one, 0.02 * n);
  }
  ASSERT_FALSE(taker_.scans.empty());
  EXPECT_TRUE(taker_.scans.back().odometry) << "it has the pose of its time";
}

class TwoLidarsTest : public ScansTest {
 protected:
  static Platform with_rear() {
    Platform p = robot();
    LidarConfig front = p.lidar(), rear = front;
    rear.topic = "rear/points";
    rear.frame = "rear";
    rear.mounting.x = -0.4;
    p.lidars = {front, rear};
    return p;
  }
  TwoLidarsTest() : ScansTest(with_rear()) {}
};

TEST_F(TwoLidarsTest, SweepsThatWaitedAreMergedWithThoseOfTheirTime) {
  odometry_clock_ = -50;
  drive(0, 2, 0, [&](double t) {
    const auto points = sweep(t);
    send_cloud(points, t);
    send_cloud({Eigen::Vector3f(5, static_cast<float>(t), 0)}, t, 0, 1);
  });
  // The odometry comes late, and frees two sweeps of each at once.
  for (const double t : {2.05, 2.1}) {
    run_until(t);
    send_cloud(sweep(t), t);
    send_cloud({Eigen::Vector3f(5, static_cast<float>(t), 0)}, t, 0, 1);
  }
  run_until(2.15);
  for (int n = 101; n <= 108; ++n) send_odometry(0.02 * n, odometry_clock_);
  run_until(2.17);
  int merged = 0;
  for (const LidarScan& scan : taker_.scans) {
    if (scan.stamp < at(1.0, 0)) continue;
    ASSERT_EQ(scan.parts.size(), 2U);
    // The rear sweep holds its own time in y; that of the same time has not been moved.
    EXPECT_NEAR(scan.points->back().y(), static_cast<double>(scan.stamp - kFirstStamp) * 1e-9, 1e-3);
    ++merged;
  }
  EXPECT_EQ(merged, 13);
}

TEST_F(ScansTest, TheStepOfAClockIsReportedOnce) {
  drive(0, 2, 0, [&](double t) { send_cloud(sweep(t), t); });
  EXPECT_THAT(codes(), Not(Contains("clock_stepped")));
  drive(2, 6, 0, [&](double t) { send_cloud(sweep(t), t, 90'000); });
  const auto all = codes();
  EXPECT_EQ(std::count(all.begin(), all.end(), "clock_stepped"), 1);
}

}  // namespace
}  // namespace adit::agent

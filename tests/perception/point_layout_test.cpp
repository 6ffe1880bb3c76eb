// SPDX-License-Identifier: Apache-2.0
#include "perception/input/point_layout.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace adit::perception {
namespace {

constexpr std::uint64_t kStamp = 1'700'000'000'000'000'000;  // ns

/// A cloud of one turn with times of the type T named `name`. Points in [first, last) of `lost` are no return
/// and lie at `nowhere`.
struct Lost {
  std::size_t first{}, last{};
  float nowhere{};
};
template <class T>
Result<Sweep> unpack(const char* name, std::uint8_t datatype, const std::vector<T>& times,
                     double duration = 0.1, Lost lost = {}) {
  const std::vector<PointField> fields{
      {"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {name, 16, datatype}, {"ring", 24, 4}};
  const auto layout = PointLayout::of(fields, 26);
  if (!layout) return layout.error();
  std::vector<std::uint8_t> data(26 * times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool is_lost = i >= lost.first && i < lost.last;
    const float n = lost.nowhere, x[3]{is_lost ? n : 1, is_lost ? n : 2, is_lost ? n : 3};
    const std::uint16_t ring = 5;
    std::memcpy(data.data() + 26 * i, x, 12);
    std::memcpy(data.data() + 26 * i + 16, &times[i], sizeof(T));
    std::memcpy(data.data() + 26 * i + 24, &ring, 2);
  }
  return layout->unpack(data, times.size(), kStamp, duration);
}

template <class T>
std::vector<T> turn(double from, double to) {
  std::vector<T> times;
  for (int i = 0; i < 1000; ++i) times.push_back(static_cast<T>(from + (to - from) * i / 999));
  return times;
}

TEST(PointLayout, ReadsTheTimesOfTheCommonDrivers) {
  const auto ouster = unpack<std::uint32_t>("t", 6, turn<std::uint32_t>(0, 99e6));
  ASSERT_TRUE(ouster) << ouster.error().text;
  EXPECT_TRUE(ouster->timed);
  EXPECT_NEAR(ouster->points.back().time, 0.099, 1e-6);
  EXPECT_EQ(ouster->points.back().ring, 5);
  const auto velodyne = unpack<float>("time", 7, turn<float>(-0.1, 0));
  ASSERT_TRUE(velodyne) << velodyne.error().text;
  EXPECT_NEAR(velodyne->points.front().time, -0.1, 1e-6);
  EXPECT_NEAR(velodyne->points.back().time, 0, 1e-6);
  const auto hesai = unpack<double>("timestamp", 8, turn<double>(1.7e9, 1.7e9 + 0.1));
  ASSERT_TRUE(hesai) << hesai.error().text;
  EXPECT_NEAR(hesai->points.back().time, 0.1, 1e-5);
  const auto livox = unpack<double>("timestamp", 8, turn<double>(1.7e18, 1.7e18 + 1e8));
  ASSERT_TRUE(livox) << livox.error().text;
  EXPECT_NEAR(livox->points.back().time, 0.1, 1e-5);
  const auto microseconds = unpack<std::uint32_t>("offset_time", 6, turn<std::uint32_t>(0, 1e5));
  ASSERT_TRUE(microseconds) << microseconds.error().text;
  EXPECT_NEAR(microseconds->points.back().time, 0.1, 1e-6);
  const auto of_another_clock = unpack<double>("timestamp", 8, turn<double>(5000, 5000.1));
  ASSERT_TRUE(of_another_clock);
  EXPECT_NEAR(of_another_clock->points.front().time, 0, 1e-5);
  EXPECT_NEAR(of_another_clock->points.back().time, 0.1, 1e-4);
}

TEST(PointLayout, OrderOfThePointsDoesNotMatter) {
  auto times = turn<float>(0, 0.1);
  std::swap(times.front(), times.back());
  std::swap(times[3], times[700]);
  const auto sweep = unpack<float>("t", 7, times);
  ASSERT_TRUE(sweep) << sweep.error().text;
  EXPECT_NEAR(sweep->points.front().time, 0.1, 1e-6);
  EXPECT_NEAR(sweep->points[3].time, 0.07, 1e-3);
}

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

// Drivers leave the time of a lost column unset: 0, NaN, or the remainder of a negative number.
TEST(PointLayout, TheTimesOfPointsWithoutAReturnDoNotCount) {
  for (const std::size_t first : {0U, 400U, 992U})
    for (const float nowhere : {0.0F, kNotANumber}) {
      const Lost lost{first, first + 8, nowhere};
      const auto set = [&lost](auto times, auto value) {
        std::fill(times.begin() + static_cast<std::ptrdiff_t>(lost.first),
                  times.begin() + static_cast<std::ptrdiff_t>(lost.last), value);
        return times;
      };
      const auto zero = unpack<double>("timestamp", 8, set(turn<double>(1.7e9, 1.7e9 + 0.1), 0.0), 0.1, lost);
      ASSERT_TRUE(zero) << zero.error().text;
      EXPECT_NEAR(zero->points[500].time, 0.05, 1e-3);
      const auto nan =
          unpack<double>("timestamp", 8, set(turn<double>(1.7e9, 1.7e9 + 0.1), std::nan("")), 0.1, lost);
      ASSERT_TRUE(nan) << nan.error().text;
      for (const TimedPoint& point : nan->points) EXPECT_TRUE(std::isfinite(point.time));
      const auto wrapped =
          unpack<std::uint32_t>("t", 6, set(turn<std::uint32_t>(0, 99e6), 2'500'000'000U), 0.1, lost);
      ASSERT_TRUE(wrapped) << wrapped.error().text;
      EXPECT_NEAR(wrapped->points[500].time, 0.05, 1e-3);
      std::size_t returns = 0;
      for (const TimedPoint& p : wrapped->points) returns += p.position == Eigen::Vector3f(1, 2, 3) ? 1 : 0;
      EXPECT_EQ(returns, 992U);
    }
}

TEST(PointLayout, AFewReturnsWithAWrongTimeAreLeftOut) {
  for (const std::size_t at : {0U, 500U, 999U}) {
    auto times = turn<double>(1.7e9, 1.7e9 + 0.1);
    times[at] = 0;
    times[(at + 7) % 1000] = std::nan("");
    const auto sweep = unpack<double>("timestamp", 8, times);
    ASSERT_TRUE(sweep) << sweep.error().text;
    EXPECT_TRUE(std::isnan(sweep->points[at].position.x()));
    std::size_t returns = 0;
    for (const TimedPoint& p : sweep->points) returns += p.position == Eigen::Vector3f(1, 2, 3) ? 1 : 0;
    EXPECT_EQ(returns, 998U);
    EXPECT_NEAR(sweep->points[300].time, 0.03, 2e-3);
  }
  auto times = turn<double>(1.7e9, 1.7e9 + 0.1);
  std::fill_n(times.begin() + 100, 30, 0.0);
  EXPECT_EQ(unpack<double>("timestamp", 8, times).reason(), Reason::sensor_times) << "3 % are not a few";
}

TEST(PointLayout, ARingThatIsNoNumberIsTheFirst) {
  for (const float ring : {kNotANumber, 1e9F, -1.0F}) {
    const auto layout =
        PointLayout::of(std::vector<PointField>{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"ring", 12, 7}}, 16);
    const float point[4]{1, 2, 3, ring};
    const auto sweep =
        layout->unpack({reinterpret_cast<const std::uint8_t*>(point), sizeof point}, 1, kStamp, 0.1);
    ASSERT_TRUE(sweep);
    EXPECT_EQ(sweep->points[0].ring, 0);
  }
}

TEST(PointLayout, RefusesTimesThatFitNoUnit) {
  EXPECT_EQ(unpack<float>("t", 7, turn<float>(0, 0.8)).reason(), Reason::sensor_times);
  EXPECT_EQ(unpack<float>("t", 7, turn<float>(0, 1e-13)).reason(), Reason::sensor_times);
  std::vector<float> times(1000, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(unpack<float>("t", 7, times).reason(), Reason::sensor_times);
  auto some = turn<float>(0, 0.1);
  for (std::size_t i = 100; i < 200; ++i) some[i] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(unpack<float>("t", 7, some).reason(), Reason::sensor_times);
}

TEST(PointLayout, EqualTimesAreOfOneInstant) {
  const auto sweep = unpack<std::uint32_t>("t", 6, std::vector<std::uint32_t>(1000, 7));
  ASSERT_TRUE(sweep);
  EXPECT_FALSE(sweep->timed);
  EXPECT_EQ(sweep->points[5].time, 0);
}

TEST(PointLayout, RefusesFieldsThatDoNotFit) {
  const std::vector<PointField> good{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
  EXPECT_TRUE(PointLayout::of(good, 12));
  EXPECT_EQ(PointLayout::of(good, 11).reason(), Reason::malformed);
  const std::vector<PointField> wide{{"x", 0, 8}, {"y", 8, 7}, {"z", 12, 7}};
  EXPECT_EQ(PointLayout::of(wide, 16).reason(), Reason::malformed) << "x is no float32";
  const std::vector<PointField> unknown{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 0, 9}};
  EXPECT_EQ(PointLayout::of(unknown, 12).reason(), Reason::malformed);
  const std::vector<PointField> outside{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 4294967295u, 7}};
  EXPECT_EQ(PointLayout::of(outside, 12).reason(), Reason::malformed);
  EXPECT_EQ(PointLayout::of(good, 12)->unpack(std::vector<std::uint8_t>(23), 2, 0, 0.1).reason(),
            Reason::malformed);
  EXPECT_TRUE(PointLayout::of(good, 12)->unpack({}, 0, 0, 0.1));
}

}  // namespace
}  // namespace adit::perception

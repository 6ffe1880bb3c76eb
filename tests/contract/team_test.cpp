// SPDX-License-Identifier: Apache-2.0
#include "core/contract/team.hpp"

#include <limits>

#include "adit/team.h"
#include "core/wire/topics.hpp"
#include "tests/contract/random_samples.hpp"

namespace adit::contract {

static void randomize(RandomSamples& random, radio::ConvoyPart& out) {
  random.any(out.convoy(), out.order_hash(), out.index(), out.left(), out.placed(), out.along(), out.gap(),
             out.wanted(), out.first(), out.points());
}
static void randomize(RandomSamples& random, radio::YieldAsk& out) {
  random.any(out.to(), out.root(), out.width(), out.route());
}
static void randomize(RandomSamples& random, radio::YieldAnswer& out) {
  random.any(out.root(), out.clears(), out.reason(), out.place());
}

namespace {

constexpr double kHalfUnit = 0.5 / kBeaconUnitsPerMetre + 1e-9;  // m

template <class T>
std::size_t size_of(const T& sample) {
  return 4 + T::getCdrSerializedSize(sample);
}

/// A number that a float holds exactly.
double any_number(RandomSamples& random, double limit) { return static_cast<float>(random.number(limit)); }

TeamBeacon any_beacon(RandomSamples& random) {
  TeamBeacon out{.robot = random.name(),
                 .pose = {any_number(random, 1e4), any_number(random, 1e4), any_number(random, 3.0)},
                 .z = any_number(random, 1e3),
                 .twist = {any_number(random, 2.0), any_number(random, 2.0), any_number(random, 2.0)},
                 .mode = random.name()};
  random.any(out.start, out.seq, out.stopped, out.rank, out.yields);
  if (random.random().chance(0.5)) out.holder = random.name();
  const Eigen::Vector3d place(out.pose.x, out.pose.y, out.z);
  const auto offset = [&random] { return random.number(327.0); };
  if (random.random().chance(0.7)) {
    ConvoyPart& part = out.convoy.emplace();
    random.any(part.convoy, part.order_hash, part.index, part.left, part.placed, part.wanted, part.first);
    part.along = any_number(random, 1e5);
    part.gap = any_number(random, 1e3);
    part.points.resize(random.random().below(ConvoyPart::kPoints + 1));
    for (Eigen::Vector3d& point : part.points) point = place + Eigen::Vector3d(offset(), offset(), offset());
  }
  if (random.random().chance(0.7)) {
    YieldAsk& ask = out.ask.emplace();
    ask.to.resize(1 + random.random().below(YieldAsk::kRobots));
    for (std::string& robot : ask.to) robot = random.name();
    ask.root = random.name();
    ask.width = 1.25;
    ask.route.resize(2 + random.random().below(YieldAsk::kPoints - 1));
    for (Eigen::Vector2d& point : ask.route) point = place.head<2>() + Eigen::Vector2d(offset(), offset());
  }
  if (random.random().chance(0.7))
    out.answer = YieldAnswer{random.name(),
                             random.random().chance(0.5),
                             Reason::yield_refused,
                             {any_number(random, 1e4), any_number(random, 1e4)}};
  return out;
}

/// Whether both have as many points, each less than half a unit of the message apart in each axis.
template <class Points>
bool close(const Points& a, const Points& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& p, const auto& q) { return (p - q).cwiseAbs().maxCoeff() <= kHalfUnit; });
}

TEST(ContractTeam, ABeaconComesBackAsItWasUpToItsScaleAndFitsItsTopic) {
  for_each_seed([](RandomSamples& random) {
    TeamBeacon sent = any_beacon(random);
    auto read = decode(through_cdr(encode(sent), wire::topics::kTeam));
    ASSERT_TRUE(read);
    ASSERT_EQ(read->convoy.has_value(), sent.convoy.has_value());
    ASSERT_EQ(read->ask.has_value(), sent.ask.has_value());
    if (sent.convoy) {
      EXPECT_TRUE(close(read->convoy->points, sent.convoy->points));
      read->convoy->points = sent.convoy->points;
    }
    if (sent.ask) {
      EXPECT_TRUE(close(read->ask->route, sent.ask->route));
      read->ask->route = sent.ask->route;
    }
    EXPECT_NEAR(read->pose.yaw, sent.pose.yaw, 1e-12) << "wrapped";
    read->pose.yaw = sent.pose.yaw;
    EXPECT_EQ(*read, sent);
  });
}

TEST(ContractTeam, ABeaconOfWhichAnyPartIsWrongIsBounded) {
  int taken = 0;
  for_each_seed([&taken](RandomSamples& random) {
    radio::TeamBeacon sample = encode(any_beacon(random));
    switch (random.random().below(8)) {
      case 0:
        random.any(sample.pose()[random.random().below(4)]);
        break;
      case 1:
        random.any(sample.mode());
        break;
      case 2:
        if (!sample.convoy().empty()) random.any(sample.convoy()[0].points());
        break;
      case 3:
        if (!sample.ask().empty()) random.any(sample.ask()[0].to(), sample.ask()[0].route());
        break;
      case 4:
        random.any(sample.convoy());
        break;
      case 5:
        random.any(sample.ask());
        break;
      case 6:
        random.any(sample.answer(), sample.speed());
        break;
      default:
        random.any(sample.robot());
    }
    const auto read = decode(through_cdr(sample));
    if (!read) return;
    ++taken;
    EXPECT_TRUE(command::valid_name(read->robot));
    EXPECT_TRUE(is_clean(read->mode, kMaxName));
    for (const double metres : {read->pose.x, read->pose.y, read->z})
      EXPECT_LE(std::fabs(metres), kFarthestPlace);
    if (read->convoy) {
      EXPECT_LE(read->convoy->points.size(), ConvoyPart::kPoints);
    }
    if (read->ask) {
      EXPECT_LE(read->ask->to.size(), YieldAsk::kRobots);
      EXPECT_LE(read->ask->route.size(), YieldAsk::kPoints);
    }
  });
  EXPECT_GT(taken, 30);
  EXPECT_LT(taken, static_cast<int>(kSeeds) - 30);
}

TeamBeacon a_beacon() {
  TeamBeacon beacon{.robot = "r2", .start = 5, .seq = 3, .pose = {300, -200, 1}, .z = 0.5};
  beacon.mode = "waypoint";
  beacon.holder = "op1";
  beacon.convoy = ConvoyPart{7, 8, 1, false, true, 3.25, 1.5, 4, 9, {}};
  for (int i = 0; i < 8; ++i) beacon.convoy->points.push_back({300 + 0.5 * i, -200.0, 0.5});
  beacon.rank = 3;
  beacon.yields = true;
  beacon.ask = YieldAsk{{"r3", "r4"}, "r2", 0.8, {{300, -200}, {303, -200}, {303, -190}}};
  beacon.answer = YieldAnswer{"r1", true, Reason::none, {301, -202}};
  return beacon;
}

TEST(ContractTeam, ABeaconArrivesAsItWasSentAndFitsItsTopic) {
  const TeamBeacon sent = a_beacon();
  const auto read = decode(encode(sent));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->robot, "r2");
  EXPECT_EQ(read->convoy->first, 9u);
  ASSERT_EQ(read->convoy->points.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_LT((read->convoy->points[i] - sent.convoy->points[i]).norm(), 0.01);
  EXPECT_EQ(read->answer, sent.answer);
  EXPECT_EQ(read->rank, 3);
  EXPECT_TRUE(read->yields);
  ASSERT_TRUE(read->ask);
  EXPECT_EQ(read->ask->to, sent.ask->to);
  EXPECT_LT((read->ask->route.back() - sent.ask->route.back()).norm(), 0.01);
  TeamBeacon longest = sent;
  longest.ask->to.assign(YieldAsk::kRobots, std::string(32, 'n'));
  longest.ask->root = longest.answer->root = std::string(32, 'n');
  longest.ask->route.assign(YieldAsk::kPoints, {300, -200});
  longest.robot = longest.holder = longest.mode = std::string(32, 'n');
  EXPECT_LE(size_of(encode(longest)), wire::topics::kTeam.max_bytes);
  TeamBeacon usual = sent;
  usual.ask.reset();
  usual.answer.reset();
  EXPECT_LE(size_of(encode(usual)), 220u) << "what BeaconRate counts on, less the headers";
  TeamBeacon far = sent;
  far.convoy->points[3].x() += 400.0;
  EXPECT_EQ(decode(encode(far))->convoy->points.size(), 3u) << "the rest would be misnumbered";
}

TEST(ContractTeam, MalformedBeaconsAreRefused) {
  const radio::TeamBeacon good = encode(a_beacon());
  ASSERT_TRUE(decode(good));
  const auto refused = [&](const auto& spoil) {
    radio::TeamBeacon bad = good;
    spoil(bad);
    return !decode(bad);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([&](auto& b) { b.pose()[0] = nan; }));
  EXPECT_TRUE(refused([&](auto& b) { b.pose()[2] = 1e30f; }));
  EXPECT_TRUE(refused([&](auto& b) { b.speed()[1] = nan; }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy()[0].along(nan); }));
  EXPECT_TRUE(refused([&](auto& b) { b.robot("r 2"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.robot(std::string(64, 'r')); }));
  EXPECT_TRUE(refused([&](auto& b) { b.holder("op\n1"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.mode(std::string(64, 'm')); }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy().resize(64, b.convoy()[0]); }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy()[0].points().resize(27); }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy()[0].points().resize(4); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].to().resize(64, "r3"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].to().clear(); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].root("r 1"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].width(nan); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].width(0.0f); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].route().resize(3); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].route().resize(26); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask().resize(2, b.ask()[0]); }));
  EXPECT_TRUE(refused([&](auto& b) { b.answer()[0].place()[1] = nan; }));
  EXPECT_TRUE(refused([&](auto& b) { b.answer()[0].root(""); }));
}

}  // namespace
}  // namespace adit::contract

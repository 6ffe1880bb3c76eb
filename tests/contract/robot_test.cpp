// SPDX-License-Identifier: Apache-2.0
#include "core/contract/robot.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "adit/robot.h"
#include "core/command/words.hpp"
#include "core/wire/topics.hpp"
#include "tests/contract/random_samples.hpp"

namespace adit::contract {

static void randomize(RandomSamples& random, radio::RobotState& out) {
  random.any(out.robot(), out.stamp(), out.x(), out.y(), out.z(), out.yaw(), out.vx(), out.vy(), out.wz(),
             out.battery(), out.sigma(), out.tilt(), out.localisation(), out.map_revision());
}
static void randomize(RandomSamples& random, radio::Route& out) {
  random.any(out.robot(), out.goal_id(), out.corners(), out.from(), out.unknown(), out.points(), out.seq());
}
static void randomize(RandomSamples& random, radio::ModeOption& out) {
  random.any(out.mode(), out.available(), out.reason());
}
static void randomize(RandomSamples& random, radio::Exploration& out) {
  random.any(out.phase(), out.reason(), out.volume(), out.share(), out.open(), out.unreachable());
}
static void randomize(RandomSamples& random, radio::Area& out) {
  random.any(out.name(), out.kind(), out.z_min(), out.z_max(), out.weight(), out.corners());
  if (random.random().chance(0.5)) out.corners().resize(2 * random.random().below(20), 1.0F);
}
static void randomize(RandomSamples& random, radio::BehaviourState& out) {
  random.any(out.robot(), out.mode(), out.stopped(), out.moving_allowed(), out.reason(), out.recovery(),
             out.goal_state(), out.goal_id(), out.goal(), out.modes(), out.convoy(), out.yields(),
             out.yields_to(), out.exploration(), out.areas(), out.seq());
}
static void randomize(RandomSamples& random, radio::Notification& out) {
  random.any(out.robot(), out.seq(), out.stamp(), out.operator_name(), out.severity(), out.code(),
             out.reason(), out.text());
}
static void randomize(RandomSamples& random, radio::ComponentHealth& out) {
  random.any(out.name(), out.state(), out.healthy(), out.automatic(), out.silent_for(), out.restarts(),
             out.hung(), out.text());
}
static void randomize(RandomSamples& random, radio::Health& out) {
  random.any(out.robot(), out.components(), out.seq());
}

namespace {

using testing::AllOf;
using testing::Each;
using testing::Ge;
using testing::Le;
using testing::SizeIs;

constexpr double kNotFinite[]{std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};

template <class T>
T returned(const T& sent) {
  return decode(through_cdr(encode(sent))).value();
}

float single(RandomSamples& random, double limit) { return static_cast<float>(random.number(limit)); }

/// An enumerator up to `last`.
template <class Enum>
Enum one_of(RandomSamples& random, Enum last) {
  return static_cast<Enum>(random.random().below(static_cast<std::uint64_t>(last) + 1));
}

Reason any_reason(RandomSamples& random) { return static_cast<Reason>(random.random().below(65'536)); }

std::size_t up_to(RandomSamples& random, std::size_t most) {
  return random.random().chance(0.1) ? most : random.random().below(most + 1);
}

bool is_clean(const std::string& text, std::size_t limit) { return command::clean(text, limit) == text; }

TEST(ContractRobot, AStateReturnsToTheScaleOfItsIntegers) {
  for_each_seed([](RandomSamples& random) {
    RobotState sent{.robot = random.name(),
                    .x = single(random, 1e4),
                    .y = single(random, 1e4),
                    .z = single(random, 1e4),
                    .yaw = single(random, M_PI),
                    .vx = single(random, 10),
                    .vy = single(random, 10),
                    .wz = single(random, 10),
                    .battery = random.random().chance(0.2) ? -1.0F : std::abs(single(random, 1)),
                    .sigma = std::abs(random.number(RobotState::kMaxSigma)),
                    .roll = random.number(RobotState::kMaxTilt),
                    .pitch = random.number(RobotState::kMaxTilt),
                    .localisation = one_of(random, Localisation::lost)};
    random.any(sent.stamp, sent.map_revision);
    RobotState back = returned(sent);
    EXPECT_NEAR(back.sigma, sent.sigma, 0.5001 / RobotState::kSigmaPerMetre);
    EXPECT_NEAR(back.roll, sent.roll, 0.5001 / RobotState::kTiltPerRadian);
    EXPECT_NEAR(back.pitch, sent.pitch, 0.5001 / RobotState::kTiltPerRadian);
    back.sigma = sent.sigma;
    back.roll = sent.roll;
    back.pitch = sent.pitch;
    EXPECT_EQ(back, sent);
  });
}

TEST(ContractRobot, AStateHasNoScaleBeyondItsLimits) {
  for (const double sigma : {1e9, kNotFinite[0], kNotFinite[1]})
    EXPECT_EQ(returned(RobotState{.robot = "r1", .sigma = sigma}).sigma, RobotState::kMaxSigma);
  EXPECT_EQ(returned(RobotState{.robot = "r1", .sigma = -1}).sigma, 0.0);
  for (const double angle : kNotFinite)
    EXPECT_EQ(returned(RobotState{.robot = "r1", .roll = angle}).roll, 0.0);
  EXPECT_EQ(returned(RobotState{.robot = "r1", .pitch = -100}).pitch, -RobotState::kMaxTilt);
}

TEST(ContractRobot, AnyStateIsWithinItsBounds) {
  for_any<radio::RobotState>([](const radio::RobotState& sample) {
    const auto state = decode(sample);
    ASSERT_EQ(state.has_value(), command::valid_name(sample.robot()));
    if (!state) return;
    EXPECT_THAT(state->sigma, AllOf(Ge(0.0), Le(RobotState::kMaxSigma)));
    EXPECT_LE(std::abs(state->roll), RobotState::kMaxTilt);
    EXPECT_LE(std::abs(state->pitch), RobotState::kMaxTilt);
    EXPECT_LE(state->battery, 1.0F);
    EXPECT_LE(state->localisation, Localisation::lost);
  });
}

TEST(ContractRobot, ARouteReturnsToTheDecimetre) {
  for_each_seed([](RandomSamples& random) {
    Route sent{.robot = random.name(), .corners = 1 + up_to(random, 65'534)};
    random.any(sent.goal_id, sent.unknown);
    for (std::size_t n = 1 + up_to(random, Route::kMaxCorners - 1); n > 0; --n)
      sent.points.emplace_back(random.number(1500), random.number(1500), random.number(100));
    Route back = returned(sent);
    ASSERT_EQ(back.points.size(), sent.points.size());
    for (std::size_t i = 0; i < sent.points.size(); ++i)
      EXPECT_LE((back.points[i] - sent.points[i]).cwiseAbs().maxCoeff(), 0.501 / Route::kOffsetsPerMetre);
    back.points = sent.points;
    EXPECT_EQ(back, sent);
  });
}

TEST(ContractRobot, ALongRouteIsCutWhereItDoesNotFit) {
  Route route{.robot = std::string(32, 'n'), .goal_id = 7, .corners = 100'000, .unknown = 2};
  for (int i = 0; i < 40; ++i) route.points.emplace_back(3.0 * i, -1.25, 0.5);
  EXPECT_LE(serialised(encode(route)).size(), wire::topics::kRoute.max_bytes);
  const Route back = returned(route);
  EXPECT_EQ(back.corners, 65'535U);
  ASSERT_EQ(back.points.size(), Route::kMaxCorners);
  EXPECT_EQ(back.points[1], Eigen::Vector3d(3.0, -1.25, 0.5));
  for (const double far : {1e9, kNotFinite[0], kNotFinite[1]}) {
    route.points[2].x() = far;
    EXPECT_EQ(returned(route).points.size(), 2U) << "no corner beyond one that does not fit";
  }
  EXPECT_EQ(returned(Route{.robot = "r1"}), Route{.robot = "r1"});
  route.points[0].y() = kNotFinite[0];
  EXPECT_EQ(returned(route), Route{.robot = route.robot}) << "a route from nowhere is none";
}

TEST(ContractRobot, AnyRouteIsWithinItsBounds) {
  for_any<radio::Route>([](const radio::Route& sample) {
    const auto route = decode(sample);
    ASSERT_EQ(route.has_value(), command::valid_name(sample.robot()));
    if (!route) return;
    EXPECT_LE(route->points.size(), Route::kMaxCorners);
    EXPECT_LE(route->corners, 65'535U);
    EXPECT_EQ(route->points.empty(), route->corners == 0);
    for (const Eigen::Vector3d& point : route->points) EXPECT_TRUE(point.allFinite());
  });
}

Area an_area(RandomSamples& random) {
  Area area{.name = random.name(),
            .kind = one_of(random, AreaKind::prefer),
            .weight = std::abs(single(random, 10))};
  if (random.random().chance(0.5)) area.z_min = single(random, 100);
  if (random.random().chance(0.5)) area.z_max = single(random, 100);
  for (std::size_t n = 3 + up_to(random, Area::kMaxCorners - 3); n > 0; --n)
    area.corners.emplace_back(single(random, Area::kFarthest), single(random, Area::kFarthest));
  return area;
}

TEST(ContractRobot, ABehaviourReturnsAsItWas) {
  for_each_seed([](RandomSamples& random) {
    BehaviourState sent{.robot = random.name(),
                        .mode = random.name(),
                        .reason = any_reason(random),
                        .recovery = one_of(random, RecoveryState::give_up),
                        .goal_state = one_of(random, GoalState::reached),
                        .goal = {random.number(1e4), random.number(1e4), random.number(1e4)}};
    random.any(sent.stopped, sent.moving_allowed, sent.goal_id, sent.yields);
    for (std::size_t n = up_to(random, BehaviourState::kMaxOptions); n > 0; --n)
      sent.options.push_back({random.name(), random.random().chance(0.5), any_reason(random)});
    for (std::size_t n = up_to(random, BehaviourState::kMaxConvoy); n > 0; --n)
      sent.convoy.push_back(random.name());
    for (std::size_t n = up_to(random, BehaviourState::kMaxAreas); n > 0; --n)
      sent.areas.push_back(an_area(random));
    if (random.random().chance(0.5)) sent.yields_to = random.name();
    if (const auto phase = one_of(random, ExplorationPhase::ended); phase != ExplorationPhase::none) {
      sent.exploration = {.phase = phase,
                          .reason = any_reason(random),
                          .volume = std::abs(single(random, 1e6)),
                          .share = std::abs(single(random, 1))};
      random.any(sent.exploration.open, sent.exploration.unreachable);
    }
    EXPECT_EQ(returned(sent), sent);
  });
}

TEST(ContractRobot, AGoalOnTheGroundHasNoHeight) {
  const BehaviourState back = returned(BehaviourState{.robot = "r1", .goal = {1, 2, kNotFinite[0]}});
  EXPECT_EQ(back.goal.head<2>(), Eigen::Vector2d(1, 2));
  EXPECT_TRUE(std::isnan(back.goal.z()));
}

TEST(ContractRobot, AreasOfAnySizeFitTheirTopic) {
  const std::string name(32, 'n');
  BehaviourState state{.robot = name, .mode = "smart_joystick", .yields_to = name};
  state.options.assign(BehaviourState::kMaxOptions, {"smart_joystick", false, Reason::stopped});
  state.convoy.assign(BehaviourState::kMaxConvoy, name);
  state.exploration.phase = ExplorationPhase::exploring;
  state.areas.assign(BehaviourState::kMaxAreas, {.name = name, .corners = {Area::kMaxCorners, {1, 2}}});
  EXPECT_LE(serialised(encode(state)).size(), wire::topics::kBehaviour.max_bytes);
}

TEST(ContractRobot, AnyBehaviourIsWithinItsBounds) {
  for_any<radio::BehaviourState>([](const radio::BehaviourState& sample) {
    const auto state = decode(sample);
    ASSERT_EQ(state.has_value(), command::valid_name(sample.robot()));
    if (!state) return;
    EXPECT_TRUE(is_clean(state->mode, kMaxName));
    EXPECT_LE(state->goal_state, GoalState::reached);
    EXPECT_THAT(state->options, SizeIs(Le(BehaviourState::kMaxOptions)));
    for (const ModeOption& option : state->options) EXPECT_TRUE(is_clean(option.mode, kMaxName));
    EXPECT_THAT(state->convoy, AllOf(SizeIs(Le(BehaviourState::kMaxConvoy)),
                                     Each(testing::ResultOf(command::valid_name, true))));
    EXPECT_TRUE(state->yields_to.empty() || command::valid_name(state->yields_to));
    EXPECT_LE(state->exploration.phase, ExplorationPhase::ended);
    EXPECT_THAT(state->exploration.volume, AllOf(Ge(0.0F), testing::Lt(1e12F)));
    EXPECT_THAT(state->exploration.share, AllOf(Ge(0.0F), Le(1.0F)));
    EXPECT_THAT(state->areas, SizeIs(Le(BehaviourState::kMaxAreas)));
    for (const Area& area : state->areas) {
      EXPECT_TRUE(command::valid_name(area.name));
      EXPECT_LE(area.kind, AreaKind::prefer);
      EXPECT_THAT(area.corners, SizeIs(AllOf(Ge(3U), Le(Area::kMaxCorners))));
      for (const Eigen::Vector2d& corner : area.corners) EXPECT_TRUE(corner.allFinite());
      EXPECT_FALSE(std::isnan(area.z_min) || std::isnan(area.z_max));
      EXPECT_GE(area.weight, 0.0);
    }
  });
}

TEST(ContractRobot, ANotificationReturnsAsItWas) {
  for_each_seed([](RandomSamples& random) {
    Notification sent{.operator_name = random.name(),
                      .severity = one_of(random, Severity::error),
                      .code = random.name(),
                      .reason = any_reason(random),
                      .text = random.name() + " stopped " + random.name(),
                      .robot = random.name()};
    random.any(sent.stamp);
    EXPECT_EQ(returned(sent), sent);
  });
}

TEST(ContractRobot, LongTextsFitTheirTopics) {
  const std::string name(32, 'n'), text(10'000, 'x');
  const Notification notification{name, Severity::warning, "mode_refused", Reason::mode_unknown, text, name};
  EXPECT_LE(serialised(encode(notification)).size(), wire::topics::kNotification.max_bytes);
  EXPECT_THAT(encode(notification).text(), testing::EndsWith("..."));
  EXPECT_EQ(returned(notification).text.size(), kMaxText);
  const Health health{name, std::vector<ComponentHealth>(8, {.name = name, .text = text})};
  EXPECT_LE(serialised(encode(health)).size(), wire::topics::kHealth.max_bytes);
  EXPECT_THAT(returned(health).components[0].text, testing::EndsWith("..."));
}

TEST(ContractRobot, AnyNotificationIsWithinItsBounds) {
  for_any<radio::Notification>([](const radio::Notification& sample) {
    const auto notification = decode(sample);
    ASSERT_EQ(notification.has_value(), command::valid_name(sample.robot()));
    if (!notification) return;
    EXPECT_TRUE(is_clean(notification->operator_name, kMaxName));
    EXPECT_TRUE(is_clean(notification->code, kMaxName));
    EXPECT_TRUE(is_clean(notification->text, kMaxText));
    const bool known = sample.severity() <= radio::SEVERITY_ERROR;
    EXPECT_EQ(notification->severity, known ? static_cast<Severity>(sample.severity()) : Severity::error);
  });
}

TEST(ContractRobot, HealthReturnsAsItWas) {
  for_each_seed([](RandomSamples& random) {
    Health sent{random.name(), std::vector<ComponentHealth>(up_to(random, Health::kMaxComponents))};
    for (ComponentHealth& part : sent.components) {
      part = {.name = random.name(), .state = one_of(random, PartState::hung), .text = random.name()};
      part.silent_for = std::abs(single(random, 1e6));
      random.any(part.healthy, part.automatic, part.restarts, part.hung);
    }
    EXPECT_EQ(returned(sent), sent);
  });
}

TEST(ContractRobot, AnyHealthIsWithinItsBounds) {
  for_any<radio::Health>([](const radio::Health& sample) {
    const auto health = decode(sample);
    ASSERT_EQ(health.has_value(), command::valid_name(sample.robot()));
    if (!health) return;
    ASSERT_EQ(health->components.size(), std::min(sample.components().size(), Health::kMaxComponents));
    for (std::size_t i = 0; i < health->components.size(); ++i) {
      const ComponentHealth& part = health->components[i];
      EXPECT_TRUE(is_clean(part.name, kMaxName));
      EXPECT_TRUE(is_clean(part.text, kMaxText));
      EXPECT_GE(part.silent_for, 0.0F);
      const bool known = sample.components()[i].state() <= radio::COMPONENT_HUNG;
      EXPECT_EQ(part.state,
                known ? static_cast<PartState>(sample.components()[i].state()) : PartState::failed);
    }
  });
}

}  // namespace
}  // namespace adit::contract

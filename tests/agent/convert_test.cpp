// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/convert.hpp"

#include <gmock/gmock.h>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "robot_agent/supervisor/health_message.hpp"

namespace adit::agent {
namespace {

template <class T>
std::size_t encoded(const T& sample) {
  std::vector<std::uint8_t> bytes;
  wire::encode(sample, bytes);
  return bytes.size();
}

// Whatever its sender made of a text, the answer fits its topic: else it would never be sent.
TEST(Convert, LongTextsFitTheirTopics) {
  const std::string name(32, 'n');
  const Notice notice{name, Severity::warning, "mode_refused", Reason::mode_unknown,
                      std::string(10'000, 'x')};
  EXPECT_LE(encoded(to_radio(notice, name)), wire::topics::kNotification.max_bytes);

  ComponentRow part{};
  part.name = name;
  part.text = std::string(10'000, 'x');
  EXPECT_LE(encoded(to_radio(std::vector<ComponentRow>(8, part), name)), wire::topics::kHealth.max_bytes);
}

TEST(Convert, AFollowedRouteOfAnyLengthFitsItsTopic) {
  const std::string name(32, 'n');
  FollowedRoute route{.goal_id = 7, .corners = 100'000, .points = {}, .unknown = 2};
  for (int i = 0; i < 40; ++i) route.points.emplace_back(3.0 * i, -1.25, 0.5);
  radio::Route sent = to_radio(route, name);
  EXPECT_LE(encoded(sent), wire::topics::kRoute.max_bytes);
  EXPECT_EQ(sent.corners(), 65535);
  ASSERT_EQ(sent.points().size(), 3 * (FollowedRoute::kMaxCorners - 1));
  EXPECT_EQ(sent.from()[1], -1.25F);
  EXPECT_EQ(sent.points()[3], 60);
  route.points[2].x() = 1e9;
  sent = to_radio(route, name);
  EXPECT_EQ(sent.points().size(), 3U) << "no corner beyond one that does not fit";
  EXPECT_EQ(to_radio(FollowedRoute{}, name).corners(), 0);
}

TEST(Convert, AreasOfAnySizeFitTheirTopics) {
  const std::string name(32, 'n');
  BehaviourView view{};
  view.mode = "smart_joystick";
  view.convoy.assign(8, name);
  view.exploration.state = ExplorationState::exploring;
  for (int i = 10; i < 26; ++i) {
    nav::Area area{.name = std::string(30, 'a') + std::to_string(i), .kind = nav::AreaKind::keep_out};
    for (int k = 0; k < 16; ++k)
      area.corners.emplace_back(20 * std::cos(k * M_PI / 8), 20 * std::sin(k * M_PI / 8));
    ASSERT_TRUE(view.areas.add(nav::checked(area).value()));
  }
  const auto state = to_radio(view, std::vector<ModeOption>(16, {"smart_joystick", Reason::stopped}), name);
  EXPECT_LE(encoded(state), wire::topics::kBehaviour.max_bytes);
  ASSERT_EQ(state.areas().size(), 16U);
  EXPECT_EQ(state.areas()[3].corners().size(), 32U);
  EXPECT_EQ(state.areas()[3].kind(), radio::AREA_KEEP_OUT);
  EXPECT_EQ(state.areas()[3].corners()[0], 20.0F);
}

TEST(Convert, CapabilitiesNameTheSteepestSlope) {
  Platform platform{};
  platform.max_slope = 1.0;
  EXPECT_NEAR(capabilities_of(platform, "r1", {}, 1, ModeTable::shipped()).max_slope, 0.785, 1e-3);
}

}  // namespace
}  // namespace adit::agent

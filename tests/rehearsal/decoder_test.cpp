// SPDX-License-Identifier: Apache-2.0
// What the checker makes of the bytes on the radio and on the robot's domain.
#include "sim/checker/radio_decoder.hpp"

#include <gtest/gtest.h>

#include "adit/command.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"

namespace adit::sim {
namespace {

template <class T>
std::vector<std::uint8_t> bytes_of(const T& sample) {
  std::vector<std::uint8_t> out;
  wire::encode(sample, out);
  return out;
}

CommandHeard heard(radio::CommandKind kind) {
  radio::Command command;
  command.robot("r1");
  command.station("op1");
  command.kind(kind);
  command.words({"planner", "auto"});
  const auto decoded = decode_received(wire::topics::kCommand.name, bytes_of(command), {});
  EXPECT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->robot, "r1");
  return std::get<CommandHeard>(decoded->event);
}

TEST(RadioDecoder, DecodesCommandsByTheirVerb) {
  const std::vector<std::pair<radio::CommandKind, Verb>> kinds{
      {radio::CMD_TAKE, Verb::take},         {radio::CMD_RELEASE, Verb::release},
      {radio::CMD_LOCK, Verb::lock},         {radio::CMD_UNLOCK, Verb::unlock},
      {radio::CMD_GRANT, Verb::grant},       {radio::CMD_STOP, Verb::stop},
      {radio::CMD_RESET, Verb::reset},       {radio::CMD_MODE, Verb::mode},
      {radio::CMD_GOTO, Verb::go_to},        {radio::CMD_QUERY, Verb::query},
      {radio::CMD_RESTART, Verb::restart},   {radio::CMD_POLICY, Verb::policy},
      {radio::CMD_PLAN, Verb::plan},         {radio::CMD_HOME, Verb::go_to},
      {radio::CMD_POSE, Verb::pose},         {radio::CMD_EXPLORE, Verb::mode},
      {radio::CMD_AREA_ADD, Verb::area_add}, {radio::CMD_AREA_REMOVE, Verb::area_remove}};
  for (const auto& [kind, verb] : kinds) EXPECT_EQ(heard(kind).verb, verb) << kind;
  EXPECT_EQ(heard(radio::CMD_RESTART).text, "planner");
  EXPECT_EQ(heard(radio::CMD_EXPLORE).text, "explore");
  EXPECT_TRUE(heard(radio::CMD_POLICY).flag);
  EXPECT_EQ(heard(static_cast<radio::CommandKind>(99)).verb, Verb::unknown);
}

TEST(RadioDecoder, AProgramsVelocityIsNoWordOfTheAgent) {
  geometry_msgs::msg::Twist twist;
  twist.linear().x(0.4);
  const auto bytes = bytes_of(twist);
  const auto decoded = decode_received(wire::topics::kExternalCmdVel.name, bytes, {});
  ASSERT_TRUE(decoded.has_value());
  EXPECT_DOUBLE_EQ(std::get<ProgramHeard>(decoded->event).velocity.vx, 0.4);
  EXPECT_FALSE(decode_sent(wire::topics::kExternalCmdVel.name, wire::topics::kExternalCmdVel.type, bytes));
}

}  // namespace
}  // namespace adit::sim

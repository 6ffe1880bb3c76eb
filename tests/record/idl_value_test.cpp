// SPDX-License-Identifier: Apache-2.0
// Samples as text, by the IDL alone: what `recording cat` shows.
#include "core/record/idl_value.hpp"

#include <gmock/gmock.h>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/robot.h"
#include "core/record/idl_schema.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::record {
namespace {

using testing::HasSubstr;

template <class T>
Result<std::string> shown(const char* dds_type, const T& sample) {
  const auto schema = idl_schema(dds_type).value();
  std::vector<std::uint8_t> cdr;
  wire::encode(sample, cdr);
  return cdr_to_json(*parse_idl(schema.text).value().at(schema.name), cdr);
}

TEST(IdlValue, ACommandReadsAsItWasWritten) {
  radio::Command command;
  command.robot("r1");
  command.station("op \"1\"\n");
  command.epoch().start(0xFEDCBA9876543210);
  command.seq(7);
  command.kind(radio::CMD_GOTO);
  command.numbers({1.5, -2.0, std::nan("")});
  command.options(1);
  const auto json = shown("adit::radio::Command", command);
  ASSERT_TRUE(json) << json.error().text;
  EXPECT_EQ(*json,
            R"({"robot":"r1","station":"op \"1\"\u000a","station_id":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0],)"
            R"("epoch":{"start":18364758544493064720,"counter":0},"seq":7,"kind":"CMD_GOTO","words":[],)"
            R"("numbers":[1.5,-2,null],"options":1})");
}

TEST(IdlValue, SequencesOfStructs) {
  radio::BehaviourState state;
  radio::ModeOption option;
  option.mode("waypoint");
  option.reason(205);
  state.modes({option, option});
  state.goal_state(radio::GOAL_KEPT);
  const auto json = shown("adit::radio::BehaviourState", state);
  ASSERT_TRUE(json) << json.error().text;
  EXPECT_THAT(*json, HasSubstr(R"("modes":[{"mode":"waypoint","available":false,"reason":205},{"mode")"));
  EXPECT_THAT(*json, HasSubstr(R"("goal_state":"GOAL_KEPT")"));
}

TEST(IdlValue, LongSequencesAreShortened) {
  sensor_msgs::msg::PointCloud2 cloud;
  cloud.header().stamp().sec(-5);
  cloud.data().assign(5000, 9);
  const auto json = shown("sensor_msgs::msg::dds_::PointCloud2_", cloud);
  ASSERT_TRUE(json) << json.error().text;
  EXPECT_THAT(*json, HasSubstr("\"and 4976 more\""));
  EXPECT_THAT(*json, HasSubstr("\"sec\":-5"));
  EXPECT_LT(json->size(), 500U);
}

TEST(IdlValue, RefusesAValueThatIsCutAtAnyByte) {
  const auto schema = idl_schema("nav_msgs::msg::dds_::Odometry_").value();
  const IdlTypes types = parse_idl(schema.text).value();
  std::vector<std::uint8_t> cdr;
  nav_msgs::msg::Odometry odometry;
  odometry.child_frame_id("base_link");
  wire::encode(odometry, cdr);
  ASSERT_TRUE(cdr_to_json(*types.at(schema.name), cdr));
  for (std::size_t size = 0; size < cdr.size(); ++size)
    ASSERT_FALSE(cdr_to_json(*types.at(schema.name), ByteSpan(cdr).first(size))) << size;
  cdr.insert(cdr.end(), 4, 0);
  EXPECT_FALSE(cdr_to_json(*types.at(schema.name), cdr)) << "too long";
}

TEST(IdlValue, BigEndianIsUnderstood) {
  const IdlTypes types = parse_idl("struct S { octet a; short b; long long c; };").value();
  const std::vector<std::uint8_t> cdr{0, 0, 0, 0, 7, 0, 0xFF, 0xFE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0};
  EXPECT_EQ(cdr_to_json(*types.at("S"), cdr).value(), R"({"a":7,"b":-2,"c":256})");
}

TEST(IdlValue, RefusesInvalidIdl) {
  for (const char* text :
       {"union U {};", "struct S { nothing x; };", "module m {", "struct S { long a[x]; };",
        "struct S { sequence<long b; };", "struct", "enum E { A B };"}) {
    const auto parsed = parse_idl(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.reason(), Reason::syntax);
  }
}

}  // namespace
}  // namespace adit::record

// SPDX-License-Identifier: Apache-2.0
// Objects on the robot domain reach stations as findings; what cannot be used is refused with its reason.
#include <gmock/gmock.h>

#include "adit/bulk.h"
#include "core/contract/bulk.hpp"
#include "core/findings/finding_piece.hpp"
#include "tests/agent/agent_bench.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace adit::agent {
namespace {

using testing::HasSubstr;
using vision_msgs::msg::Detection3DArray;

class Detections : public testing::Test {
 protected:
  void begin(AgentParams params = {}) {
    params.start = {10.0, 0.0, M_PI / 2};
    bench = std::make_unique<AgentBench>(std::move(params));
    op1 = &bench->join("op1");
    camera = bench->network().join(100, "camera");
    wire::Topic<Detection3DArray> topic = wire::topics::kDetections;
    topic.max_bytes = 16 << 20;  // The camera's own bound.
    writer = wire::Writer<Detection3DArray>::make(*camera, topic).value();
    acks = wire::Writer<radio::BulkAck>::make(*op1->wire, wire::topics::kBulkAck).value();
    reader = wire::make_reader(*op1->wire, wire::topics::kBulk, bench->strand(),
                               [this](const radio::BulkPiece& piece, const wire::SampleInfo&) {
                                 const auto decoded = findings::decode_piece(piece.data());
                                 if (!decoded) return;
                                 for (const auto& each : decoded->findings) found[each.key.id] = each;
                               })
                 .value();
    timer = bench->strand().every(1s, [this] {
      (void)acks.write(encode(contract::BulkAck{.station = op1->name, .station_id = op1->id, .start = 7}));
    });
    bench->run(4s);
  }
  ~Detections() override {
    reader.reset();
    writer = {};
    camera.reset();
  }
  Detection3DArray seen(const std::string& frame, double x, Duration age = 100ms) const {
    Detection3DArray out;
    const auto ns = (bench->strand().now() - age).time_since_epoch().count();
    out.header().frame_id(frame);
    out.header().stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    out.header().stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
    out.detections().resize(1);
    out.detections()[0].results().resize(1);
    out.detections()[0].results()[0].hypothesis().class_id("person");
    out.detections()[0].results()[0].hypothesis().score(0.9);
    out.detections()[0].results()[0].pose().pose().position().x(x);
    return out;
  }
  void send(const std::string& frame, double x, Duration age = 100ms) {
    for (int n = 0; n < 5; ++n) {
      EXPECT_TRUE(writer.write(seen(frame, x, age)));
      bench->run(100ms);
    }
    bench->run(2s);
  }
  std::string notice() const {
    for (const auto& each : op1->notices)
      if (each.code() == "sensor_refused") return each.text();
    return "none";
  }

  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator* op1{};
  std::unique_ptr<wire::Participant> camera{};
  wire::Writer<Detection3DArray> writer{};
  wire::Writer<radio::BulkAck> acks{};
  std::unique_ptr<wire::RawReader> reader{};
  Timer timer{};
  std::map<std::uint64_t, findings::Finding> found{};
};

TEST_F(Detections, BecomeOneFindingAtItsPlaceInTheMap) {
  AgentParams params;
  params.detections.importance["person"] = 9;
  begin(std::move(params));
  bench->send_frame("camera", 0.5);
  send("camera", 3.0);
  ASSERT_EQ(found.size(), 1U);
  const findings::Finding& person = found.begin()->second;
  EXPECT_EQ(person.kind, "person");
  EXPECT_EQ(person.importance, 9);
  EXPECT_EQ(person.text, "score 0.90");
  EXPECT_NEAR(person.position[0], 10.0, 0.01);
  EXPECT_NEAR(person.position[1], 3.0, 0.01) << "the robot looks along y";
  EXPECT_NEAR(person.position[2], 0.5, 0.01);
  EXPECT_EQ(notice(), "none");
}

TEST_F(Detections, AreWhereTheRobotWasAtTheirStamp) {
  begin();
  ASSERT_EQ(bench->ask(*op1, radio::CMD_TAKE), Reason::none);
  bench->stream(*op1, 0.0, 300ms);
  ASSERT_EQ(bench->ask(*op1, radio::CMD_MODE, "manual"), Reason::none);
  bench->stream(*op1, 1.0, 3s);
  const Pose2 before = bench->pose;
  const Detection3DArray then = seen("base_link", 3.0, 0ms);
  bench->stream(*op1, 1.0, 1s);
  ASSERT_GT(bench->pose.x, before.x + 0.5);
  for (int n = 0; n < 3; ++n) {
    EXPECT_TRUE(writer.write(then));
    bench->run(100ms);
  }
  bench->run(2s);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.begin()->second.position[1], before.x + 3.0, 0.05);
}

TEST_F(Detections, AreTakenInMapAndOdom) {
  begin();
  send("map", 50.0);
  send("odom", 7.0);
  std::vector<std::array<double, 3>> places;
  for (const auto& [id, each] : found) places.push_back(each.position);
  ASSERT_EQ(places.size(), 2U);
  std::sort(places.begin(), places.end());
  EXPECT_NEAR(places[0][0], 10.0, 0.01);
  EXPECT_NEAR(places[0][1], 7.0, 0.01);
  EXPECT_NEAR(places[1][0], 50.0, 0.01);
}

TEST_F(Detections, OfAnUnknownFrameAreRefusedWithItsName) {
  begin();
  send("base_link", 3.0);  // Frames may come late after the first message.
  bench->run(3s);
  send("attic", 3.0);
  EXPECT_EQ(found.size(), 1U);
  EXPECT_THAT(notice(), HasSubstr("the frame 'attic'"));
  EXPECT_THAT(notice(), HasSubstr("(1 refused so far)"));
  int notices = 0;
  for (const auto& each : op1->notices) notices += each.code() == "sensor_refused" ? 1 : 0;
  EXPECT_EQ(notices, 1) << "one for many";
}

TEST_F(Detections, OfAnotherClockAreRefused) {
  begin();
  send("base_link", 3.0, -60s);
  EXPECT_THAT(notice(), HasSubstr("ahead of the odometry"));
  op1->notices.clear();
  bench->run(15s);
  send("base_link", 3.0, 12s);
  EXPECT_THAT(notice(), HasSubstr("behind the odometry"));
  EXPECT_TRUE(found.empty());
  send("base_link", 3.0, -30ms);
  EXPECT_EQ(found.size(), 1U) << "the odometry comes a little later";
}

TEST_F(Detections, TenThousandObjectsAreRefusedAndTheNextMessageCounts) {
  begin();
  Detection3DArray flood = seen("base_link", 3.0);
  flood.detections().resize(10'000, flood.detections()[0]);
  EXPECT_TRUE(writer.write(flood));
  bench->run(3s);
  EXPECT_THAT(notice(), HasSubstr("1024 kB"));
  send("base_link", 3.0);
  EXPECT_EQ(found.size(), 1U);
}

TEST_F(Detections, OfAnotherTypeAreReported) {
  begin();
  auto other = bench->network().join(100, "other");
  const wire::TopicInfo plain{"rt/detections",        "vision_msgs::msg::dds_::Detection2DArray_",
                              wire::QosClass::sensor, 1,
                              wire::topics::kUnkeyed, 1024};
  auto wrong = other->make_writer(plain, "");
  bench->run(2s);
  std::string text;
  for (const auto& each : op1->notices)
    if (each.code() == "type_differs") text = each.text();
  EXPECT_THAT(text, HasSubstr("sends vision_msgs/msg/Detection2DArray"));
  wrong = Error{Reason::none, ""};
  other.reset();
}

}  // namespace
}  // namespace adit::agent

// SPDX-License-Identifier: Apache-2.0
// Reports on the robot domain reach stations as findings with photos; what cannot be used is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "adit/bulk.h"
#include "core/contract/bulk.hpp"
#include "core/findings/finding_piece.hpp"
#include "core/findings/photo_piece.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/agent/agent_bench.hpp"
#include "tests/findings/drawn_photo.hpp"
#include "visualization_msgs/msg/Marker.h"

namespace adit::agent {
namespace {

using testing::HasSubstr;
using visualization_msgs::msg::Marker;

class Reports : public testing::Test {
 protected:
  void begin(AgentParams params = {}) {
    params.start = {10.0, 0.0, M_PI / 2};
    params.disk = disk;
    bench = std::make_unique<AgentBench>(std::move(params));
    op1 = &bench->join("op1");
    program = bench->network().join(100, "program");
    wire::Topic<Marker> topic = wire::topics::kReports;
    topic.max_bytes = 64 << 20;  // The program's own bound.
    writer = wire::Writer<Marker>::make(*program, topic).value();
    acks = wire::Writer<radio::BulkAck>::make(*op1->wire, wire::topics::kBulkAck).value();
    reader =
        wire::make_reader(*op1->wire, wire::topics::kBulk, bench->strand(),
                          [this](const radio::BulkPiece& piece, const wire::SampleInfo&) { hear(piece); })
            .value();
    timer = bench->strand().every(1s, [this] {
      contract::BulkAck ack{.station = op1->name, .station_id = op1->id, .start = 7};
      if (receipt.newest > 0) ack.receipts.emplace_back("r1", receipt);
      (void)acks.write(encode(ack));
    });
    bench->run(4s);
  }
  ~Reports() override {
    reader.reset();
    writer = {};
    program.reset();
  }
  void hear(const radio::BulkPiece& piece) {
    if (piece.session() != receipt.session) receipt = {piece.session(), 0, {~0ULL, ~0ULL}};
    receipt.newest = std::max(receipt.newest, piece.id());
    if (piece.kind() == static_cast<std::uint8_t>(transfer::Kind::photos)) {
      const auto photo = findings::decode_photo_piece(piece.data());
      ASSERT_TRUE(photo.ok());
      if (photo->part == findings::PhotoPart::thumbnail) thumbnails.insert(photo->content);
      return;
    }
    const auto decoded = findings::decode_piece(piece.data());
    if (!decoded) return;
    for (const auto& each : decoded->findings) found[each.key.id] = each;
  }
  Marker report(const std::string& frame, double x, std::int32_t number = 1) const {
    Marker out;
    const auto ns = (bench->strand().now() - 100ms).time_since_epoch().count();
    out.header().frame_id(frame);
    out.header().stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    out.header().stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
    out.ns("person");
    out.id(number);
    out.text("under the beam");
    out.pose().position().x(x);
    return out;
  }
  void send(const Marker& marker, Duration then = 4s) {
    EXPECT_TRUE(writer.write(marker));
    bench->run(then);
  }
  std::string notices() const {
    std::string out;
    for (const auto& each : op1->notices)
      if (each.code() == "sensor_refused") out += each.text() + "\n";
    return out;
  }

  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator* op1{};
  std::unique_ptr<wire::Participant> program{};
  wire::Writer<Marker> writer{};
  wire::Writer<radio::BulkAck> acks{};
  std::unique_ptr<wire::RawReader> reader{};
  Timer timer{};
  transfer::Receipt receipt{};  ///< Of all pieces: nothing is lost here.
  std::map<std::uint64_t, findings::Finding> found{};
  std::set<std::uint64_t> thumbnails{};
};

TEST_F(Reports, BecomeAFindingWithItsPhoto) {
  begin();
  Marker marker = report("base_link", 3.0);
  marker.texture().data() = findings::draw({});
  send(marker);
  ASSERT_EQ(found.size(), 1U);
  const findings::Finding& person = found.begin()->second;
  EXPECT_EQ(person.kind, "person");
  EXPECT_EQ(person.text, "under the beam");
  EXPECT_EQ(person.importance, 9) << "as of a mark";
  EXPECT_NEAR(person.position[0], 10.0, 0.01);
  EXPECT_NEAR(person.position[1], 3.0, 0.01) << "the robot looks along y";
  ASSERT_TRUE(person.photo.has_value());
  EXPECT_EQ(person.photo->content, findings::photo_hash(findings::draw({})));
  EXPECT_EQ(thumbnails, std::set{person.photo->content});
  EXPECT_EQ(notices(), "");
}

TEST_F(Reports, ChangeAndWithdrawTheFindingOfTheirNumber) {
  begin();
  Marker marker = report("base_link", 3.0);
  marker.texture().data() = findings::draw({});
  send(marker);
  ASSERT_EQ(found.size(), 1U);
  const auto photo = found.begin()->second.photo;
  Marker changed = report("base_link", 3.0);
  changed.text("carried away");
  send(changed);
  EXPECT_EQ(found.begin()->second.text, "carried away");
  EXPECT_EQ(found.begin()->second.photo, photo) << "a report without a photo leaves it";
  const std::uint32_t revision = found.begin()->second.revision;
  for (int n = 0; n < 30; ++n) {
    Marker same = report("base_link", 3.0);
    same.text("carried away");
    send(same, 100ms);
  }
  bench->run(3s);
  EXPECT_EQ(found.begin()->second.revision, revision) << "nothing to see";
  Marker gone = report("base_link", 3.0);
  gone.action(2);
  send(gone);
  EXPECT_TRUE(found.begin()->second.withdrawn);
  send(report("base_link", 3.0));
  EXPECT_FALSE(found.begin()->second.withdrawn);
  EXPECT_EQ(found.size(), 1U);
  bench->stop_agent();
  bench->start_agent();
  bench->run(4s);
  Marker again = report("base_link", 5.0);
  send(again, 6s);
  EXPECT_EQ(found.size(), 1U) << "also after a restart of the agent";
  EXPECT_NEAR(found.begin()->second.position[1], 5.0, 0.1);
  EXPECT_EQ(found.begin()->second.photo, photo);
}

TEST_F(Reports, APhotoThatCannotBeUsedCostsOnlyThePhoto) {
  begin();
  Marker huge = report("base_link", 1.0, 1);
  huge.texture().data().assign(20'000'000, 0xff);
  send(huge, 12s);
  Marker broken = report("base_link", 2.0, 2);
  broken.texture().data() = findings::draw({});
  broken.texture().data().resize(3000);
  send(broken, 12s);
  Marker bomb = report("base_link", 3.0, 3);
  bomb.texture().data() = findings::draw({.width = 16, .height = 16});
  auto& bytes = bomb.texture().data();
  for (std::size_t i = 0; i + 8 < bytes.size(); ++i)
    if (bytes[i] == 0xff && bytes[i + 1] == 0xc0) bytes[i + 5] = bytes[i + 7] = 0x27;
  send(bomb, 12s);
  EXPECT_EQ(found.size(), 3U);
  for (const auto& [id, finding] : found) EXPECT_FALSE(finding.photo.has_value());
  EXPECT_THAT(notices(), HasSubstr("19531 kB"));
  EXPECT_THAT(notices(), HasSubstr("is no whole JPEG"));
  EXPECT_THAT(notices(), HasSubstr("more pixels"));
  EXPECT_THAT(notices(), HasSubstr("(3 refused so far)"));
}

TEST_F(Reports, OfAnUnknownFrameOrClockAreRefused) {
  begin();
  send(report("base_link", 1.0, 1), 6s);
  send(report("attic", 1.0, 2), 12s);
  Marker old = report("base_link", 1.0, 3);
  old.header().stamp().sec(old.header().stamp().sec() - 12);
  send(old, 12s);
  Marker nan = report("base_link", std::nan(""), 4);
  send(nan, 12s);
  EXPECT_EQ(found.size(), 1U);
  EXPECT_THAT(notices(), HasSubstr("the frame 'attic'"));
  EXPECT_THAT(notices(), HasSubstr("behind the odometry"));
  EXPECT_THAT(notices(), HasSubstr("is no number"));
}

TEST_F(Reports, AFloodOfPhotosIsBounded) {
  begin();
  for (std::int32_t n = 0; n < 60; ++n) {
    Marker marker = report("base_link", 1.0 + n, n);
    marker.texture().data() = findings::draw(
        {.width = 200, .height = 150, .noise = true, .seed = static_cast<std::uint64_t>(n + 1)});
    send(marker, 50ms);
  }
  bench->run(10s);
  EXPECT_THAT(notices(), HasSubstr("more photos than can be decoded"));
  EXPECT_LE(found.size(), 26U) << "20 at once and one a second";
  EXPECT_GE(found.size(), 20U);
}

}  // namespace
}  // namespace adit::agent

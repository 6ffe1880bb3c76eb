// SPDX-License-Identifier: Apache-2.0
// The radio side of a robot that carries maps, against robots that send what they should not.
#include <gmock/gmock.h>

#include "adit/bulk.h"
#include "core/config/platform_file.hpp"
#include "core/transfer/piece.hpp"
#include "perception/stream/piece.hpp"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Another robot, reduced to its messages: it announces itself and reaches for carriers.
class OtherRobot {
 public:
  OtherRobot(AgentBench& bench, const std::string& name) : wire_(bench.network().join(77, name)) {
    capabilities_ = wire::Writer<radio::Capabilities>::make(*wire_, wire::topics::kCapabilities).value();
    presence_ = wire::Writer<radio::Presence>::make(*wire_, wire::topics::kPresence).value();
    bulk_ = wire::Writer<radio::BulkPiece>::make(*wire_, wire::topics::kBulk, wire::topics::kCarryPartition)
                .value();
    acks_ = wire::make_reader(
                *wire_, wire::topics::kBulkAck, bench.strand(),
                [this](const radio::BulkAck& ack, const wire::SampleInfo&) { heard.push_back(ack); },
                wire::topics::kCarryPartition)
                .value();
    radio::Capabilities self;
    self.name(name);
    self.kind(radio::AGENT_ROBOT);
    self.id({7});
    self.protocol(1);
    (void)capabilities_.write(self);
    beat_ = bench.strand().every(500ms, [this, name] {
      radio::Presence presence;
      presence.name(name);
      presence.kind(radio::AGENT_ROBOT);
      presence.id({7});
      presence.protocol(1);
      (void)presence_.write(presence);
    });
  }
  void send(const std::string& as, std::uint32_t id, const std::string& map_of) {
    radio::BulkPiece piece;
    piece.robot(as);
    piece.session(3);
    piece.id(id);
    piece.kind(static_cast<std::uint8_t>(transfer::Kind::map_blocks));
    const std::vector<perception::BlockUpdate> blocks{{{{1, 2, 0}, 3, 1}, 4}};
    piece.data(perception::pack({map_of, 5, 0}, blocks, 1200).bytes);
    (void)bulk_.write(piece);
  }
  std::vector<std::string> acknowledged() const {
    std::vector<std::string> robots;
    for (const radio::BulkAck& ack : heard)
      for (const radio::BulkReceipt& receipt : ack.receipts()) robots.push_back(receipt.robot());
    return robots;
  }
  std::vector<radio::BulkAck> heard{};

 private:
  std::unique_ptr<wire::Participant> wire_;
  wire::Writer<radio::Capabilities> capabilities_{};
  wire::Writer<radio::Presence> presence_{};
  wire::Writer<radio::BulkPiece> bulk_{};
  std::unique_ptr<wire::RawReader> acks_{};
  Timer beat_{};
};

AgentParams carrier(bool carries) {
  AgentParams params{};
  params.name = "r1";
  params.platform = config::load_platform("wheeled").value();
  params.carry_maps = carries;
  return params;
}

TEST(CarryRadio, AcknowledgesTheMapOfTheRobotThatSentIt) {
  AgentBench bench(carrier(true));
  OtherRobot other(bench, "r2");
  bench.run(3s);
  other.heard.clear();
  other.send("r2", 1, "r2");
  bench.run(2s);
  ASSERT_THAT(other.acknowledged(), ElementsAre("r2"));
  const radio::BulkAck& ack = other.heard.front();
  EXPECT_TRUE(ack.carrier());
  EXPECT_EQ(ack.station(), "r1");
  EXPECT_EQ(ack.receipts()[0].newest(), 1U);
}

TEST(CarryRadio, ARobotSpeaksForItselfAloneAndOfItsOwnMap) {
  AgentBench bench(carrier(true));
  OtherRobot other(bench, "r2");
  bench.run(3s);
  other.heard.clear();
  other.send("r3", 1, "r3");
  other.send("r1", 1, "r1");
  other.send("r2", 1, "r3");
  bench.run(10s);
  EXPECT_FALSE(other.heard.empty()) << "it shows that it is there";
  EXPECT_THAT(other.acknowledged(), IsEmpty());
}

TEST(CarryRadio, HasAnotherIdAfterARestart) {
  AgentBench bench(carrier(true));
  OtherRobot other(bench, "r2");
  bench.run(6s);
  ASSERT_FALSE(other.heard.empty());
  const auto before = other.heard.back().station_id();
  bench.stop_agent();
  bench.start_agent();
  bench.run(6s);
  EXPECT_NE(other.heard.back().station_id(), before);
}

TEST(CarryRadio, WithoutPermissionNothingIsTaken) {
  AgentBench bench(carrier(false));
  OtherRobot other(bench, "r2");
  bench.run(3s);
  other.send("r2", 1, "r2");
  bench.run(10s);
  EXPECT_THAT(other.heard, IsEmpty());
}

}  // namespace
}  // namespace adit::agent

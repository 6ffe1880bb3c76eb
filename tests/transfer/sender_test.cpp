// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/sender.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "core/time/random.hpp"
#include "core/transfer/receiver.hpp"
#include "tests/transfer/toy_source.hpp"

namespace adit::transfer {
namespace {

/// A station of the test: the content that arrived, and its acknowledgements.
struct ToyStation {
  PeerId id{};
  std::uint32_t start{1};
  Receiver receiver{};
  std::map<std::uint8_t, std::uint8_t> has{};

  void restart() {
    ++start;
    receiver = Receiver{};
    has.clear();
  }
};

/// A sender and stations beside a link that loses, repeats and reorders.
class TransferTest : public testing::Test {
 public:
  TransferTest() {
    sender.add(source);
    for (std::uint8_t i = 0; i < stations.size(); ++i) stations[i].id.fill(static_cast<std::uint8_t>(i + 1));
    for (int part = 0; part < 200; ++part) source.set(static_cast<std::uint8_t>(part), 1);
  }
  void run(Duration span, std::size_t active = 2) {
    for (const Time end = now + span; now < end; now += 50ms) {
      for (const Piece& piece : sender.due(now, link)) {
        ++pieces;
        bytes += piece.data.size() + kPieceOverhead;
        for (std::size_t s = 0; s < active; ++s)
          send([this, s, piece] {
            ToyStation& station = stations[s];
            if (!station.receiver.take("r1", sender.session(), piece.id, now)) return;
            for (std::size_t i = 0; i + 1 < piece.data.size(); i += ToySource::kPart)
              station.has[piece.data[i]] = piece.data[i + 1];
          });
      }
      for (std::size_t s = 0; s < active; ++s)
        if (const auto due = stations[s].receiver.due(now, profile.bandwidth)) {
          Ack ack{stations[s].id, stations[s].start, {}};
          for (const auto& [robot, receipt] : *due) ack.receipt = receipt;
          if (!random.chance(ack_loss)) send([this, ack] { sender.acknowledged(ack, now); });
        }
      std::vector<std::pair<Time, std::function<void()>>> arriving;
      std::erase_if(air, [&](auto& message) {
        if (message.first > now) return false;
        arriving.push_back(std::move(message));
        return true;
      });
      for (auto& [at, arrive] : arriving) arrive();
    }
  }
  void send(const std::function<void()>& arrive) {
    const int copies = random.chance(repeated) ? 2 : 1;
    for (int i = 0; i < copies; ++i)
      if (!random.chance(loss))
        air.emplace_back(now + 50ms + from_seconds(random.uniform(0.0, jitter)), arrive);
  }
  bool complete(std::size_t s) const {
    if (stations[s].has.size() != source.size()) return false;
    for (const auto& [part, value] : stations[s].has)
      if (source.value(part) != value) return false;
    return true;
  }

  wire::LinkProfile profile{.name = "mesh_500k", .bandwidth = 500e3};
  wire::SenderState link{.link = &profile};
  double loss{}, ack_loss{}, repeated{}, jitter{};
  Random random{3};
  Time now{10s};
  ToySource source{};
  Sender sender{{.session = 77}};
  std::array<ToyStation, 3> stations{};
  std::vector<std::pair<Time, std::function<void()>>> air{};
  std::size_t pieces{}, bytes{};
};

TEST_F(TransferTest, SendsNothingUntilAStationIsHeard) {
  EXPECT_TRUE(sender.due(now, link).empty());
  EXPECT_TRUE(sender.due(now + 10s, link).empty());
}

TEST_F(TransferTest, EveryStationGetsEverythingOnce) {
  run(20s);
  EXPECT_TRUE(complete(0));
  EXPECT_TRUE(complete(1));
  EXPECT_LE(source.losses, 3) << "two in a row";
  EXPECT_EQ(sender.in_flight(), 0U);
  EXPECT_EQ(source.open_tokens(), 0U);
  EXPECT_LE(pieces, 3U);  // One part is four bytes, and a piece is for both stations.
}

TEST_F(TransferTest, SurvivesLossRepetitionAndReordering) {
  profile.bandwidth = 100e3;
  loss = 0.3, repeated = 0.1, jitter = 0.5;
  for (std::uint8_t round = 2; round < 12; ++round) {
    for (int part = 0; part < 200; part += 3) source.set(static_cast<std::uint8_t>(part), round);
    run(3s);
  }
  run(60s);
  EXPECT_TRUE(complete(0));
  EXPECT_TRUE(complete(1));
  EXPECT_GT(source.losses, 0);
  EXPECT_EQ(sender.in_flight(), 0U);
  EXPECT_EQ(source.open_tokens(), 0U);
}

TEST_F(TransferTest, AStationThatIsCutOffGetsTheNewestStateAfterwards) {
  run(10s);
  for (std::uint8_t value = 2; value < 100; ++value) {
    source.set(5, value);
    run(1s, 1);  // Station 1 neither hears nor answers.
  }
  const std::size_t before = pieces;
  run(20s);
  EXPECT_TRUE(complete(1));
  EXPECT_EQ(stations[1].has.at(5), 99);
  EXPECT_LE(pieces - before, 10U) << "what is out of date is not sent";
}

TEST_F(TransferTest, AStationThatRestartsGetsEverythingAgain) {
  run(10s);
  stations[0].restart();
  run(10s);
  EXPECT_TRUE(complete(0));
  EXPECT_EQ(source.joins, 3);
}

TEST_F(TransferTest, ALateAcknowledgementOfAnEarlierStartChangesNothing) {
  run(10s);
  const Ack old{stations[0].id, stations[0].start, {77, 1, {1, 0}}};
  stations[0].restart();
  run(10s);
  const int joins = source.joins;
  for (int i = 0; i < 100; ++i) {
    sender.acknowledged(old, now);
    run(100ms);
  }
  EXPECT_EQ(source.joins, joins);
  EXPECT_TRUE(complete(0));
}

TEST_F(TransferTest, HostileAcknowledgementsStayBoundedAndTheRestGoesOn) {
  loss = 0.1;
  for (int i = 0; i < 2000; ++i) {
    Ack ack{};
    for (auto& byte : ack.peer) byte = static_cast<std::uint8_t>(random.below(3) == 0 ? random.next() : 1);
    ack.start = static_cast<std::uint32_t>(random.below(4));
    ack.receipt = {random.chance(0.5) ? 77U : 1U,
                   static_cast<std::uint32_t>(random.next() >> (32 + random.below(32))),
                   {random.next(), random.next()}};
    sender.acknowledged(ack, now);
    EXPECT_LE(sender.peers(), 16U);
    EXPECT_LE(sender.in_flight(), 96U);
    if (i % 10 == 0) run(50ms);
  }
  source.set(7, 42);
  run(60s);
  stations[0].restart(), stations[1].restart();
  stations[0].start += 100, stations[1].start += 100;
  run(60s);
  EXPECT_TRUE(complete(1));
}

TEST_F(TransferTest, KeepsToItsShareOfTheLink) {
  profile.bandwidth = 100e3;
  std::size_t before = 0;
  run(5s, 1);
  before = bytes;
  for (int i = 0; i < 200; ++i) {
    for (int part = 0; part < 200; ++part)
      source.set(static_cast<std::uint8_t>(part), static_cast<std::uint8_t>(i));
    run(100ms, 1);
  }
  const double share = static_cast<double>(bytes - before) * 8 / 20 / profile.bandwidth;
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 0.6);
}

TEST_F(TransferTest, PieceCountsWaitingPartsOfAllSources) {
  ToySource other;
  for (int part = 0; part < 7; ++part) other.set(static_cast<std::uint8_t>(part), 1);
  sender.add(other);
  sender.acknowledged({stations[0].id, 1, {}}, now);
  std::vector<Piece> sent;
  for (; sent.empty(); now += 50ms) sent = sender.due(now, link);
  const std::size_t inside = sent.front().data.size() / ToySource::kPart;
  EXPECT_EQ(sent.front().waiting, 200 - inside + 7);
}

TEST_F(TransferTest, AnAcknowledgementThatIsLostMakesLittleGoTwice) {
  profile.bandwidth = 100e3;
  ack_loss = 0.1;
  for (std::uint8_t i = 0; i < 100; ++i) {
    source.set(i, 2);
    run(600ms, 1);
  }
  run(10s, 1);
  EXPECT_TRUE(complete(0));
  EXPECT_GT(pieces, 50U);
  EXPECT_LE(source.losses, 3) << "two in a row";
}

TEST_F(TransferTest, AfterACutItGoesOnAtTheRateFromBefore) {
  run(10s, 1);
  loss = 1.0;
  for (int part = 0; part < 200; ++part) source.set(static_cast<std::uint8_t>(part), 2);
  run(60s, 1);
  EXPECT_FALSE(complete(0));
  loss = 0.0;
  for (int part = 0; part < 200; ++part) source.set(static_cast<std::uint8_t>(part), 3);
  Duration took{};
  for (; took < 60s && !complete(0); took += 100ms) run(100ms, 1);
  EXPECT_LT(took, 8s) << "the idle period of acknowledgements, and the time of the content";
}

TEST_F(TransferTest, AStationThatGoesBackToAnEarlierStartIsServedOnceThePresentOneIsSilent) {
  run(20s, 1);
  EXPECT_TRUE(complete(0));
  stations[0].restart();
  run(20s, 1);
  EXPECT_TRUE(complete(0));
  run(15s, 0);
  stations[0].restart();
  stations[0].start = 1;
  run(20s, 1);
  EXPECT_TRUE(complete(0));
}

}  // namespace
}  // namespace adit::transfer

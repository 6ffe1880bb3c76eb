// SPDX-License-Identifier: Apache-2.0
// A robot's map on its way to a station through a robot that carries it.
#include <gmock/gmock.h>

#include <optional>

#include "basestation/content/digest_list.hpp"
#include "basestation/content/piece_reader.hpp"
#include "basestation/map/map_replica.hpp"
#include "robot_agent/carry/carrier.hpp"
#include "tests/agent/map_bench.hpp"

namespace adit::agent {
namespace {

/// A station with a disk.
struct Base {
  explicit Base(Executor& home) : strand(home) { restart(); }

  void restart() {
    pieces.emplace(
        [this] { return strand.now(); },
        [this](const station::PieceReader::Piece& piece, const station::PieceReader::Stored& stored) {
          return replica->take(piece.robot, piece.kind, piece.waiting, piece.data, stored);
        });
    digests = {};
    replica.emplace(++starts, disk, strand, [](const std::string&) {});
    (void)replica->load();
  }
  std::map<perception::SubmapKey, std::map<perception::BlockIndex, std::pair<std::uint64_t, std::uint64_t>>>
  map_of(const std::string& robot) const {
    std::map<perception::SubmapKey, std::map<perception::BlockIndex, std::pair<std::uint64_t, std::uint64_t>>>
        out;
    const auto found = replica->chunks().robots().find(robot);
    if (found == replica->chunks().robots().end()) return out;
    for (const auto& [key, submap] : found->second.submaps)
      for (const auto& [index, block] : submap.blocks) out[key][index] = {block.known, block.occupied};
    return out;
  }

  Executor& strand;
  transfer::PeerId id{1};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::uint32_t starts{100};
  std::optional<station::PieceReader> pieces{};
  std::optional<station::MapReplica> replica{};
  station::DigestList digests{};
};

/// The robot r1 of the bench, the robot r2 that carries its map, and a station. Who meets whom is set by the
/// test; pieces and acknowledgements are lost at random.
class CarryTest : public MapBench, public testing::Test {
 protected:
  CarryTest() { restart_carrier(); }

  void restart_carrier() {
    ++carrier_starts;
    carrier_sender = std::make_unique<transfer::Sender>(transfer::SenderParams{.session = carrier_starts});
    carrier = std::make_unique<Carrier>(carrier_starts, bounds);
    if (computes) carrier->compute_on(*strand, [] {});
    for (transfer::Source* source : carrier->sources()) carrier_sender->add(*source);
  }
  bool arrives() { return !random.chance(loss); }

  void pass(Duration span) {
    for (const Time end = strand->now() + span; strand->now() < end;
         scheduler.run_until(scheduler.elapsed() + 50ms)) {
      const Time now = strand->now();
      keeper->follow(frame);
      keeper->tick(now);
      carrier->tick(now);
      for (const transfer::Piece& piece : sender->due(now, link)) {
        ++(piece.for_carriers ? to_carrier : to_base);
        if (piece.for_carriers ? meets_carrier && arrives() : reaches_base && arrives())
          hear(piece, piece.for_carriers, now);
      }
      for (const transfer::Piece& piece : carrier_sender->due(now, link)) {
        ++carried;
        carried_bytes += piece.data.size();
        if (carrier_reaches_base && arrives())
          base.pieces->take({"r2", carrier_sender->session(), piece.id, static_cast<std::uint8_t>(piece.kind),
                             piece.waiting, piece.data});
      }
      if (const auto due = carrier->due(now, profile.bandwidth); due && meets_carrier && arrives()) {
        transfer::Ack ack{.peer = carrier->id(), .start = 1, .carrier = true};
        for (const auto& [robot, receipt] : *due)
          if (robot == name) ack.receipt = receipt;
        (void)sender->acknowledged(ack, now);
      }
      if (const auto due = base.pieces->due(profile.bandwidth)) acknowledge(*due, now);
    }
  }
  void hear(const transfer::Piece& piece, bool by_carrier, Time now) {
    const auto kind = static_cast<std::uint8_t>(piece.kind);
    const contract::BulkPiece sent{name, sender->session(), piece.id, kind, piece.waiting, piece.data};
    if (by_carrier)
      EXPECT_TRUE(carrier->take(sent, now).ok());
    else
      base.pieces->take(sent);
  }
  void acknowledge(const std::vector<std::pair<std::string, transfer::Receipt>>& due, Time now) {
    transfer::Ack ack{.peer = base.id, .start = base.replica->start()};
    for (const auto& [robot, receipt] : due) ack.senders.push_back(robot);
    if (const auto digests = base.digests.due(base.replica->chunks(), due.size(), profile.bandwidth, now);
        digests && lists_digests) {
      ack.digests = digests->list;
      ack.all_digests = digests->all;
    }
    const auto give = [&](const std::string& to, transfer::Sender& from) {
      ack.receipt = {};
      for (const auto& [robot, receipt] : due)
        if (robot == to) ack.receipt = receipt;
      return from.acknowledged(ack, now);
    };
    if (reaches_base && arrives() && give(name, *sender)) keeper->heard(ack);
    if (carrier_reaches_base && arrives() && give("r2", *carrier_sender)) carrier->heard(ack, now);
  }
  /// The robot's map, as a station that misses nothing gets it.
  decltype(std::declval<Base>().map_of("")) robots_map() {
    transfer::Sender direct({.session = 9000});
    for (transfer::Source* source : keeper->sources()) direct.add(*source);
    Base witness(*strand);
    witness.id = {99};
    for (const Time end = strand->now() + 200s; strand->now() < end;
         scheduler.run_until(scheduler.elapsed() + 50ms)) {
      keeper->tick(strand->now());
      for (const transfer::Piece& piece : direct.due(strand->now(), link))
        witness.pieces->take(
            {name, 9000, piece.id, static_cast<std::uint8_t>(piece.kind), piece.waiting, piece.data});
      if (const auto due = witness.pieces->due(profile.bandwidth)) {
        transfer::Ack ack{.peer = witness.id, .start = 1};
        for (const auto& [robot, receipt] : *due) ack.receipt = receipt;
        (void)direct.acknowledged(ack, strand->now());
      }
    }
    return witness.map_of(name);
  }

  wire::LinkProfile profile{.name = "mesh_500k", .bandwidth = 500e3};
  wire::SenderState link{.link = &profile};
  Random random{5};
  double loss{0.1};
  bool meets_carrier{false}, reaches_base{false}, carrier_reaches_base{false}, lists_digests{true};
  std::size_t to_base{}, to_carrier{}, carried{}, carried_bytes{};
  std::uint32_t carrier_starts{10};
  std::unique_ptr<transfer::Sender> carrier_sender{};
  CarryBounds bounds{};
  bool computes{false};  ///< The carrier decodes and encodes by `compute`, as on a robot.
  std::unique_ptr<Carrier> carrier{};
  Base base{*strand};
};

TEST_F(CarryTest, TheMapOfARobotThatNeverReachesTheStationComesThroughAnother) {
  drive(0, 12);
  meets_carrier = true;
  pass(60s);
  EXPECT_GT(to_carrier, 0U);
  EXPECT_TRUE(base.map_of(name).empty());
  meets_carrier = false;
  pass(20s);
  carrier_reaches_base = true;
  pass(60s);
  const auto has = base.map_of(name);
  EXPECT_GT(has.size(), 0U);
  EXPECT_EQ(has, robots_map());
  EXPECT_EQ(to_base, 0U);
  const auto& robot = base.replica->chunks().robots().at(name);
  EXPECT_EQ(robot.carried_blocks, robot.blocks);
  EXPECT_THAT(robot.carriers, testing::ElementsAre(testing::Key("r2")));
  EXPECT_FALSE(robot.heard);
  for (const auto& [key, submap] : robot.submaps) EXPECT_TRUE(submap.T_map_submap) << key.index;
}

TEST_F(CarryTest, AMapThatTheStationHasIsNotCarried) {
  drive(0, 12);
  reaches_base = true;
  pass(200s);
  reaches_base = false;
  meets_carrier = true;
  pass(60s);
  meets_carrier = false;
  carrier_reaches_base = true;
  pass(60s);
  EXPECT_GT(to_carrier, 0U);
  EXPECT_EQ(carried, 0U);
}

TEST_F(CarryTest, DifferingPartsAreCarriedOnce) {
  drive(0, 30);
  reaches_base = true;
  pass(200s);
  reaches_base = false;
  drive(30, 36);
  meets_carrier = true;
  pass(200s);
  meets_carrier = false;
  carrier_reaches_base = true;
  pass(60s);
  EXPECT_EQ(base.map_of(name), robots_map());
  const auto& robot = base.replica->chunks().robots().at(name);
  EXPECT_LT(robot.carried_blocks, robot.blocks / 2);
  const std::size_t once = carried;
  EXPECT_GT(once, 0U);
  pass(120s);
  EXPECT_EQ(carried, once);
}

TEST_F(CarryTest, AStationThatListsNoDigestsGetsAllOnce) {
  lists_digests = false;
  drive(0, 12);
  meets_carrier = true;
  pass(60s);
  carrier_reaches_base = true;
  pass(60s);
  EXPECT_EQ(base.map_of(name), robots_map());
  const std::size_t once = carried;
  pass(120s);
  EXPECT_EQ(carried, once);
}

TEST_F(CarryTest, ACarrierThatIsStartedAgainHasNothingAndGetsItAgain) {
  drive(0, 12);
  meets_carrier = true;
  pass(60s);
  restart_carrier();
  EXPECT_EQ(carrier->blocks().size(), 0U);
  meets_carrier = false;
  carrier_reaches_base = true;
  pass(30s);
  EXPECT_TRUE(base.map_of(name).empty());
  meets_carrier = true;
  pass(90s);
  EXPECT_EQ(base.map_of(name), robots_map());
}

TEST_F(CarryTest, AStationThatComesBackGoesFirstAndNothingGoesToBoth) {
  drive(0, 12);
  meets_carrier = true;
  pass(40s);
  const std::size_t before = to_carrier;
  EXPECT_GT(before, 0U);
  reaches_base = carrier_reaches_base = true;
  drive(12, 20);
  pass(10s);
  const std::size_t then = to_carrier;
  pass(120s);
  EXPECT_EQ(to_carrier, then);
  EXPECT_GT(to_base, 0U);
  EXPECT_EQ(base.map_of(name), robots_map());
}

TEST_F(CarryTest, ARestartedStationStillHasTheCarriedMap) {
  drive(0, 12);
  meets_carrier = carrier_reaches_base = true;
  pass(90s);
  const auto before = base.map_of(name);
  const std::size_t once = carried;
  EXPECT_FALSE(before.empty());
  const std::uint32_t start = base.replica->start();
  base.restart();
  EXPECT_EQ(base.replica->start(), start);
  EXPECT_EQ(base.map_of(name), before);
  pass(60s);
  EXPECT_EQ(carried, once);
}

TEST_F(CarryTest, StationAndCarrierMeetInAnyOrderOnABadLink) {
  for (std::uint64_t number = 1; number <= 4; ++number) {
    random = Random(number);
    loss = 0.3;
    computes = number % 2 == 0;
    bounds.slice = number % 2 == 0 ? 7 : 3000;
    restart_carrier();
    double x = 0;
    for (int episode = 0; episode < 12; ++episode) {
      reaches_base = random.chance(0.3);
      meets_carrier = random.chance(0.5);
      carrier_reaches_base = random.chance(0.5);
      drive(x, x + 3);
      x += random.chance(0.5) ? 3 : -3;
      pass(from_seconds(random.uniform(5.0, 40.0)));
      if (random.chance(0.2)) restart_carrier();
      if (random.chance(0.2)) base.restart();
    }
    loss = 0.1;
    reaches_base = false;
    meets_carrier = carrier_reaches_base = true;
    pass(300s);
    EXPECT_EQ(base.map_of(name), robots_map()) << "seed " << number;
  }
}

}  // namespace
}  // namespace adit::agent

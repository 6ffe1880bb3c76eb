// SPDX-License-Identifier: Apache-2.0
// Sixteen robots at once send their maps and findings to one station, beside robots that send anything else.
#include <gtest/gtest.h>

#include <set>

#include "basestation/content/piece_reader.hpp"
#include "basestation/findings/desk.hpp"
#include "basestation/map/map_replica.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/findings/finding_piece.hpp"
#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"

namespace adit::station {
namespace {

using perception::BlockUpdate;
using perception::SubmapKey;
using transfer::Kind;

constexpr std::size_t kMaxRobots = 64;  // Of a station: ChunkStoreParams, FindingDesk, PieceReader.

struct Content {
  std::uint8_t kind{};
  std::vector<std::uint8_t> data{};
};

findings::Finding some_finding(const std::string& robot, std::uint64_t id) {
  findings::Finding f;
  f.key = {robot, id};
  f.kind = "artifact";
  f.position = {1, 2, 3};
  f.text = "a backpack";
  return f;
}
Content poses(const SubmapKey& key, double x, std::uint32_t revision) {
  return {2, perception::encode({{{key, Pose3::level({x, 0, 0}, 0.1), revision}}})};
}
Content found(const std::string& robot, std::uint64_t id) {
  return {3, findings::encode({robot, 1, 0, {some_finding(robot, id)}})};
}

/// A robot that sends all that it has until it is acknowledged, in any order.
struct CrowdRobot {
  std::string name{};
  std::uint32_t session{};
  std::uint32_t last_id{};
  std::vector<Content> contents{};
  std::map<SubmapKey, std::map<perception::BlockIndex, BlockUpdate>> map{};  ///< The complete map.
  std::map<SubmapKey, std::uint32_t> pose_revisions{};
  std::size_t findings{};
  std::map<std::uint32_t, std::size_t> sent{};  ///< By id of the piece: which content.
  std::set<std::size_t> acknowledged{};
  std::vector<std::pair<std::uint32_t, Content>> earlier{};  ///< What an enemy recorded.

  bool done() const { return acknowledged.size() == contents.size(); }

  /// Adds a state of some blocks.
  void see(const SubmapKey& key, std::uint32_t revision, Random& random) {
    std::vector<BlockUpdate> blocks;
    for (int n = 0; n < 40; ++n) {
      const std::uint64_t known = random.next();
      blocks.push_back({{{static_cast<int>(random.below(12)), static_cast<int>(random.below(12)), 0},
                         known,
                         known & random.next()},
                        revision});
    }
    const perception::PackedPiece packed = perception::pack(key, blocks, transfer::kMaxPieceBytes);
    ASSERT_GT(packed.count, 0U);
    contents.push_back({1, packed.bytes});
    const auto piece = perception::decode(packed.bytes);
    ASSERT_TRUE(piece);
    for (const BlockUpdate& update : piece->blocks) {
      BlockUpdate& has = map[key][update.block.index];
      if (update.revision > has.revision) has = update;
    }
  }
  void make_content(Random& random) {
    for (std::uint32_t submap = 0; submap < 3; ++submap) {
      const SubmapKey key{name, 5, submap};
      for (std::uint32_t revision = 1; revision <= 6; ++revision) see(key, revision, random);
      for (std::uint32_t revision = 1; revision <= 3; ++revision)
        contents.push_back(poses(key, revision, revision));
      pose_revisions[key] = 3;
    }
    findings = 6;
    for (std::uint64_t id = 1; id <= findings; ++id) contents.push_back(found(name, id));
  }
};

class ContentCrowd : public testing::Test {
 protected:
  ContentCrowd() {
    restart();
    for (std::size_t i = 0; i < 16; ++i) {
      CrowdRobot robot{"r" + std::to_string(i), static_cast<std::uint32_t>(random.below(1000) + 2)};
      robot.make_content(random);
      robots.push_back(std::move(robot));
    }
  }
  void restart() {
    reader.emplace([this] { return strand->now(); },
                   [this](const PieceReader::Piece& piece, const PieceReader::Stored& stored) {
                     if (piece.kind == static_cast<std::uint8_t>(Kind::findings))
                       return desk->hear(piece.robot, piece.data, stored);
                     return replica->take(piece.robot, piece.kind, piece.waiting, piece.data, stored);
                   });
    replica.emplace(++starts, disk, *strand, [this](const std::string& text) { troubles.push_back(text); });
    lost = replica->load();
    desk.emplace(DeskParams{}, finding_disk, *strand,
                 FindingDesk::Outputs{[](const findings::Finding&) {},
                                      [this](const std::string& code, const std::string&) {
                                        if (code != "store_works") troubles.push_back(code);
                                      }});
    (void)desk->load();
  }
  void arrive(const std::string& robot, std::uint32_t session, std::uint32_t id, const Content& content) {
    reader->take({robot, session, id, content.kind, 0, content.data});
  }
  /// A piece that must be refused.
  void arrive_bad(const std::string& robot, const Content& content) {
    ++(content.kind == 3 ? bad_findings : bad_map);
    arrive(robot, 1, static_cast<std::uint32_t>(random.next() | 1), content);
  }
  /// One step of an honest robot over a link that loses, repeats, delays and reorders.
  void send(CrowdRobot& robot) {
    for (int n = 0; n < 3 && !robot.done(); ++n) {
      std::size_t which = random.below(robot.contents.size());
      while (robot.acknowledged.contains(which)) which = (which + 1) % robot.contents.size();
      const std::uint32_t id = ++robot.last_id;
      robot.sent[id] = which;
      if (robot.earlier.size() < 60) robot.earlier.emplace_back(id, robot.contents[which]);
      for (int copies = random.chance(0.2) ? 2 : 1; copies > 0; --copies)
        if (!random.chance(0.3))
          air.emplace(random.below(10), [this, &robot, id, which] {
            arrive(robot.name, robot.session, id, robot.contents[which]);
          });
    }
  }
  Content damaged(Content content) {
    if (random.chance(0.5))
      content.data.resize(random.below(content.data.size()));
    else
      content.data[random.below(content.data.size())] ^= static_cast<std::uint8_t>(1U << random.below(8));
    return content;
  }
  /// What an enemy sends who speaks as an honest robot, or as himself.
  void attack(CrowdRobot& robot) {
    const Content& content = robot.contents[random.below(robot.contents.size())];
    const std::string enemy = "enemy" + std::to_string(random.below(2));
    switch (random.below(7)) {
      case 0:
        return arrive_bad(robot.name, damaged(content));
      case 1:  // Content of another robot.
        return arrive_bad(enemy, content);
      case 2: {  // Another version.
        Content other = content;
        other.data[0] = static_cast<std::uint8_t>(other.data[0] + 1 + random.below(200));
        return arrive_bad(enemy, other);
      }
      case 3: {  // Recorded, in any order.
        if (robot.earlier.empty()) return;
        const auto& [id, old] = robot.earlier[random.below(robot.earlier.size())];
        return arrive(robot.name, random.chance(0.3) ? 1 : robot.session, id, old);
      }
      case 4:  // From the future.
        arrive(enemy, 1, static_cast<std::uint32_t>(random.next()),
               poses({enemy, random.next(), 0}, 1, static_cast<std::uint32_t>(-1)));
        return;
      case 5:  // An unknown kind.
        ++unknown;
        return arrive(enemy, 1, static_cast<std::uint32_t>(random.next()),
                      {static_cast<std::uint8_t>(4 + random.below(200)), {1, 2, 3}});
      default: {
        Content noise{static_cast<std::uint8_t>(1 + random.below(3)), {}};
        noise.data.resize(random.below(3000));
        for (std::uint8_t& byte : noise.data) byte = static_cast<std::uint8_t>(random.next());
        return arrive_bad(enemy, noise);
      }
    }
  }
  void acknowledge() {
    const auto due = reader->due(1e7);
    if (!due) return;
    EXPECT_LE(due->size(), 16U);
    for (const auto& [name, receipt] : *due)
      for (CrowdRobot& robot : robots)
        if (robot.name == name && robot.session == receipt.session)
          std::erase_if(robot.sent, [&, &receipt = receipt](const auto& sent) {
            if (receipt.has(sent.first)) robot.acknowledged.insert(sent.second);
            return receipt.has(sent.first);
          });
  }
  void step() {
    for (CrowdRobot& robot : robots) send(robot);
    for (int n = 0; n < 8; ++n) attack(robots[random.below(robots.size())]);
    // Of each delay, what was sent first arrives first.
    for (auto it = air.begin(); it != air.end() && random.chance(0.97); it = air.erase(it)) it->second();
    scheduler.run_until(scheduler.elapsed() + 50ms);
    acknowledge();
  }
  bool all_done() const {
    return std::all_of(robots.begin(), robots.end(), [](const CrowdRobot& robot) { return robot.done(); });
  }
  void expect_complete() const {
    for (const CrowdRobot& robot : robots) {
      const auto& has = replica->chunks().robots().at(robot.name);
      ASSERT_EQ(has.submaps.size(), robot.map.size()) << robot.name;
      for (const auto& [key, blocks] : robot.map) {
        const auto& submap = has.submaps.at(key);
        EXPECT_EQ(submap.pose_revision, robot.pose_revisions.at(key));
        ASSERT_EQ(submap.blocks.size(), blocks.size()) << robot.name;
        for (const auto& [index, wanted] : blocks) {
          const auto& block = submap.blocks.at(index);
          ASSERT_EQ(block.revision, wanted.revision);
          ASSERT_EQ(block.known, wanted.block.known);
          ASSERT_EQ(block.occupied, wanted.block.occupied);
        }
      }
      for (std::uint64_t id = 1; id <= robot.findings; ++id)
        EXPECT_TRUE(desk->all().contains({robot.name, id})) << robot.name << " " << id;
    }
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("op1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("station")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::shared_ptr<store::MemoryDisk> finding_disk{std::make_shared<store::MemoryDisk>()};
  Random random{16};
  std::uint32_t starts{40};
  std::string lost{};
  std::vector<std::string> troubles{};
  std::optional<PieceReader> reader{};
  std::optional<MapReplica> replica{};
  std::optional<FindingDesk> desk{};
  std::vector<CrowdRobot> robots{};
  std::multimap<std::uint64_t, std::function<void()>> air{};
  std::uint64_t bad_map{}, bad_findings{}, unknown{};
};

TEST_F(ContentCrowd, TheMapsAndFindingsOfSixteenRobotsAreCompleteWhateverElseIsSent) {
  for (int n = 0; n < 1000 && !all_done(); ++n) step();
  ASSERT_TRUE(all_done());
  expect_complete();
  EXPECT_TRUE(troubles.empty()) << troubles[0];
  EXPECT_GT(bad_map, 100U);
  EXPECT_GT(bad_findings, 20U);
  EXPECT_EQ(replica->receiver().refused(), bad_map + unknown);
  EXPECT_EQ(reader->refused(Kind::map_blocks) + reader->refused(Kind::map_poses), bad_map);
  EXPECT_EQ(reader->refused(Kind::findings), bad_findings);
  EXPECT_EQ(desk->all().size(), 16 * robots[0].findings) << "nothing that an enemy made up";
  scheduler.run_until(scheduler.elapsed() + 5s);
  restart();
  EXPECT_EQ(lost, "");
  expect_complete();
}

TEST_F(ContentCrowd, TheSixtyFifthRobotIsRefusedAndTheOthersStayComplete) {
  const auto name = [](int i) { return "a" + std::to_string(i); };  // Before "r" in every order of names.
  constexpr int few = kMaxRobots - 16;
  std::uint64_t surplus = 0;
  for (int n = 0; n < 1000 && !all_done(); ++n) {
    for (CrowdRobot& robot : robots) send(robot);
    for (auto it = air.begin(); it != air.end(); it = air.erase(it)) it->second();
    const auto id = static_cast<std::uint32_t>(n + 1);
    // Each has something new all the time.
    for (int i = 0; i < few; ++i) arrive(name(i), 3, id, poses({name(i), 5, 0}, n, id));
    if (n > 0)
      for (int i = few; i < few + 40; ++i, ++surplus)
        arrive(name(i), 3, id, i % 2 == 0 ? poses({name(i), 5, 0}, n, id) : found(name(i), 1));
    scheduler.run_until(scheduler.elapsed() + 50ms);
    acknowledge();
    ASSERT_LE(replica->chunks().robots().size(), kMaxRobots);
    ASSERT_LE(desk->robots().size(), kMaxRobots);
  }
  ASSERT_TRUE(all_done());
  expect_complete();
  EXPECT_GT(surplus, 0U);
  EXPECT_EQ(replica->receiver().refused(), surplus / 2);
  EXPECT_EQ(replica->chunks().robots().size(), kMaxRobots);
  EXPECT_FALSE(replica->chunks().robots().contains(name(few)));
}

}  // namespace
}  // namespace adit::station

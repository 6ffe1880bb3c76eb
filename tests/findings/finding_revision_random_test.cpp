// SPDX-License-Identifier: Apache-2.0
// Findings that change at random over links that lose, repeat and reorder, with restarts, full disks and
// power cuts of the robot and of the stations.
#include <cstdlib>

#include "tests/findings/source_bench.hpp"

namespace adit::agent {
namespace {

/// Knows what was sent and acknowledged, beside the classes under test.
class FindingRevisions : public FindingSourceTest, public testing::WithParamInterface<std::uint64_t> {
 protected:
  using Revision = std::pair<std::uint64_t, std::uint32_t>;  ///< An id and its revision.

  FindingRevisions() {
    random = Random(GetParam());
    on_sent = [this](std::uint32_t piece, const findings::FindingPiece& content) {
      for (const findings::Finding& f : content.findings) {
        const auto [known, is_new] = contents.try_emplace({f.key.id, f.revision}, f);
        EXPECT_EQ(known->second, f) << "a revision has one content";
        pieces[{session, piece}].emplace_back(f.key.id, f.revision);
      }
    };
    on_receipt = [this](const Operator& op, const transfer::Receipt& receipt) {
      if (receipt.session != session) return;  // Of the robot's process before.
      for (const auto& [piece, revisions] : pieces)
        if (piece.first == receipt.session && receipt.has(piece.second))
          for (const auto& [id, revision] : revisions) {
            std::uint32_t& most = acknowledged[op.id[0]][id];
            most = std::max(most, revision);
          }
    };
  }
  /// Every revision that was acknowledged is on the station's disk, or a newer one.
  void check() {
    for (const Operator& op : ops) {
      if (!op.disk->powered()) continue;
      for (const auto& [id, revision] : acknowledged[op.id[0]]) {
        const auto bytes = op.disk->read(findings::file_name({"r1", id}));
        ASSERT_TRUE(bytes && *bytes) << id;
        const auto finding = findings::from_file(**bytes);
        ASSERT_TRUE(finding) << id;
        EXPECT_GE(finding->revision, revision) << id;
        EXPECT_EQ(*finding, contents.at({id, finding->revision})) << id;
      }
    }
  }
  std::uint64_t any_id() {
    const auto& all = source->finding_store().all();
    if (all.empty()) return 0;
    return std::next(all.begin(), static_cast<std::ptrdiff_t>(random.below(all.size())))->first.id;
  }
  void act() {
    const std::uint64_t id = any_id();
    Operator& op = ops[random.below(ops.size())];
    switch (random.below(40)) {
      case 0:
      case 1:
        report(++last_id, static_cast<std::uint8_t>(random.below(3)));
        break;
      case 2:
        EXPECT_EQ(source->withdraw(id).ok(), id != 0);
        break;
      case 3:
        start(op);
        break;
      case 4:
        if (random.chance(0.5)) start_robot();
        break;
      case 5:
        op.disk->set_full(random.chance(0.3));
        break;
      case 6:
        disk->set_full(random.chance(0.3));
        break;
      case 7:
        op.heard = random.chance(0.7);
        break;
      case 8:
        if (random.chance(0.3)) cut_station(op);
        break;
      case 9:
        if (random.chance(0.3)) cut_robot();
        break;
      default:
        EXPECT_EQ(source->update(content(id, ++changes)).ok(), id != 0);
    }
  }
  /// The process goes on for a moment, as writes begin to fail.
  void cut_station(Operator& op) {
    op.disk->cut_power_after(random.below(2000));
    for (int i = 0; i < 8; ++i) run_and_check();
    op.disk->cut_power();
    op.disk->power_up();
    start(op);
  }
  void cut_robot() {
    disk->cut_power_after(random.below(2000));
    for (int i = 0; i < 8; ++i) run_and_check();
    disk->cut_power();
    disk->power_up();
    start_robot();
  }
  void run_and_check() {
    if (random.chance(0.5)) (void)source->update(content(any_id(), ++changes));
    run(300ms);
    check();
  }

  std::map<Revision, findings::Finding> contents{};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Revision>> pieces{};  ///< By session and id.
  std::map<std::uint8_t, std::map<std::uint64_t, std::uint32_t>> acknowledged{};      ///< By station and id.
  std::uint64_t last_id{};
  int changes{};
};

TEST_P(FindingRevisions, OfWhichOneIsAcknowledgedAreAtTheStationAndTheNewestArrive) {
  loss = 0.25;
  repeats = 0.2;
  delays = 0.3;
  for (int i = 0; i < 300 && !HasFailure(); ++i) {
    act();
    run(200ms);
    check();
  }
  // An acknowledgement that the link delays for longer than the sender waits is a loss: with those, a piece
  // may be due again at any time.
  loss = delays = repeats = 0.0;
  disk->set_full(false);
  for (Operator& op : ops) {
    op.disk->set_full(false);
    op.heard = true;
  }
  run(60s);
  check();
  std::size_t revised = 0;
  for (const auto& [key, finding] : source->finding_store().all()) {
    revised += finding.revision > 0 ? 1 : 0;
    for (const Operator& op : ops) EXPECT_EQ(at(op, key.id), finding);
  }
  EXPECT_GT(revised, 0U);
  EXPECT_GT(acknowledged.size(), 1U);
  const std::size_t total = sent.size();
  run(30s);
  EXPECT_EQ(sent.size(), total) << "then nothing is sent";
}

/// ADIT_CHAOS_SEEDS: how many; more in a campaign.
std::uint64_t revision_seeds() {
  const char* wanted = std::getenv("ADIT_CHAOS_SEEDS");
  return wanted == nullptr ? 24 : std::strtoull(wanted, nullptr, 10);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FindingRevisions, testing::Range<std::uint64_t>(1, 1 + revision_seeds()));

}  // namespace
}  // namespace adit::agent

#include "robot_agent/state/snapshot.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"
#include "robot_agent/state/restored.hpp"

namespace adit::agent {
namespace {

using testing::HasSubstr;

Id id_of(char c) {
  Id id{};
  id.fill(static_cast<std::uint8_t>(c));
  return id;
}

Snapshot full() {
  Snapshot s;
  s.authority = {{77, 12},
                 Party{"op1", id_of('a')},
                 Binding::Kept{{1, 2, 3}, wire::ParticipantId{4, 5, 6}, wire::ParticipantId{7, 8}},
                 true,
                 {{"op2", id_of('b')}, {"others", Id{}}}};
  s.behaviour = {"waypoint", Reason::stopped, true, false, 9, {1.5, -2, 0.25}, true};
  s.boot = 0x1122334455667788;
  s.battery = 2;
  KeptAnswers a;
  a.participant[3] = 4;
  a.station = "op1";
  a.station_id = id_of('a');
  a.newest = 12;
  a.newest_of = {12, 11, 3};
  a.floor = 5;
  a.answers = {{11, Reason::none, ""}, {12, Reason::locked, "locked by op2"}};
  s.answers = {a};
  return s;
}

Snapshot largest() {
  Snapshot s = full();
  s.authority.holder->name = std::string(32, 'h');
  s.authority.stops.assign(16, {std::string(32, 's'), id_of('s')});
  s.answers.front().station = std::string(32, 'n');
  s.answers.front().newest = std::numeric_limits<std::uint64_t>::max();
  s.answers.front().answers.assign(8, {1'000'000, Reason::locked, std::string(64, 't')});
  s.answers.assign(8, s.answers.front());
  return s;
}

TEST(Snapshot, gives_back_what_was_put) {
  EXPECT_EQ(decode_snapshot(encode(full())), full());
  EXPECT_EQ(decode_snapshot(encode(largest())), largest());
  EXPECT_EQ(decode_snapshot(encode(Snapshot{})), Snapshot{});
}

TEST(Snapshot, is_bounded) {
  EXPECT_LE(encode(largest()).size(), kSnapshotFormat.most);
  Snapshot beyond = largest();
  beyond.authority.stops.resize(40, {"op9", Id{}});
  beyond.answers.resize(100, beyond.answers.front());
  for (KeptAnswers& a : beyond.answers) a.answers.resize(50, {2, Reason::none, std::string(5000, 'x')});
  EXPECT_LE(encode(beyond).size(), kSnapshotFormat.most);
  const auto back = decode_snapshot(encode(beyond));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->authority.stops.size(), 16u);
}

TEST(Snapshot, takes_no_bytes_that_no_robot_wrote) {
  const store::Bytes whole = encode(full());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_snapshot(std::span(whole).first(size))) << size;
  store::Bytes longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(decode_snapshot(longer));

  Snapshot s = full();
  s.authority.holder.reset();
  EXPECT_FALSE(decode_snapshot(encode(s))) << "locked by nobody";
  s = full();
  s.authority.holder->name = "no name";
  EXPECT_FALSE(decode_snapshot(encode(s)));
  s = full();
  s.authority.stops.front().name = "";
  EXPECT_FALSE(decode_snapshot(encode(s)));
  s = full();
  s.behaviour.goal.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(decode_snapshot(encode(s)));
  s = full();
  s.battery = 4;
  EXPECT_FALSE(decode_snapshot(encode(s)));
  s = full();
  s.answers.front().answers.front().seq = 13;
  EXPECT_FALSE(decode_snapshot(encode(s))) << "an answer to a number that was never seen";
}

TEST(Snapshot, takes_any_bytes) {
  Random random(3);
  const store::Bytes whole = encode(largest());
  for (int i = 0; i < 5000; ++i) {
    store::Bytes junk = whole;
    for (std::uint64_t edits = 1 + random.below(5); edits > 0; --edits)
      junk[random.below(junk.size())] = static_cast<std::uint8_t>(random.next());
    if (random.chance(0.3)) junk.resize(random.below(junk.size()));
    const auto s = decode_snapshot(junk);
    EXPECT_TRUE(!s || encode(*s).size() <= kSnapshotFormat.most);
  }
}

class RestoreTest : public testing::Test {
 protected:
  Result<void> save(const Snapshot& s) { return save(encode(s)); }
  Result<void> save(const store::Bytes& payload) {
    return store::StateFile(disk, kStateFile, kSnapshotFormat).save(5, payload);
  }
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
};

TEST_F(RestoreTest, GivesTheStateThatWasSaved) {
  ASSERT_TRUE(save(full()).ok());
  const Restored r = restore_state(disk);
  EXPECT_FALSE(r.lost);
  EXPECT_EQ(r.snapshot, full());
  EXPECT_EQ(r.generation, 5u);
}

TEST_F(RestoreTest, NothingIsAFirstStart) {
  EXPECT_FALSE(restore_state(disk).lost);
  EXPECT_FALSE(restore_state(disk).snapshot);
  EXPECT_FALSE(restore_state(nullptr).lost);
}

TEST_F(RestoreTest, AMissingStateThatOnceWasIsLost) {
  ASSERT_TRUE(disk->replace(kMarkerFile, {}).ok());
  EXPECT_TRUE(restore_state(disk).lost);
}

TEST_F(RestoreTest, WhatCannotBeUsedIsLostWithItsReason) {
  const store::Bytes whole = store::seal(kSnapshotFormat, 5, encode(full()));
  const auto lost = [&](store::Bytes bytes) {
    disk->plant(kStateFile, std::move(bytes));
    const Restored r = restore_state(disk);
    EXPECT_TRUE(r.lost);
    EXPECT_FALSE(r.snapshot);
    return r.text;
  };
  EXPECT_THAT(lost({}), HasSubstr("torn"));
  EXPECT_THAT(lost({whole.begin(), whole.end() - 9}), HasSubstr("torn"));
  store::Bytes bent = whole;
  bent[40] ^= 1;
  EXPECT_THAT(lost(bent), HasSubstr("corrupt"));
  EXPECT_THAT(lost(store::seal(kSnapshotFormat, 5, store::Bytes(30, 9))), HasSubstr("corrupt"));
  store::StateFormat format = kSnapshotFormat;
  format.version = 0;
  EXPECT_THAT(lost(store::seal(format, 5, encode(full()))), HasSubstr("older"));
  format.version = 9;
  EXPECT_THAT(lost(store::seal(format, 5, encode(full()))), HasSubstr("newer"));
  EXPECT_THAT(lost(store::Bytes(50, 'x')), HasSubstr("foreign"));
  EXPECT_THAT(lost(store::Bytes(1'000'000, 'x')), HasSubstr("unreadable"));
}

TEST_F(RestoreTest, TheIdentityIsDrawnOnceAndKept) {
  EXPECT_EQ(restore_identity(disk, id_of('x')), id_of('x'));
  EXPECT_EQ(restore_identity(disk, id_of('y')), id_of('x'));
  disk->plant(kIdentityFile, store::Bytes(10, 1));
  EXPECT_EQ(restore_identity(disk, id_of('z')), id_of('z')) << "one that cannot be read is drawn anew";
  EXPECT_EQ(restore_identity(disk, id_of('y')), id_of('z'));
  EXPECT_EQ(restore_identity(nullptr, id_of('y')), id_of('y'));
}

}  // namespace
}  // namespace adit::agent

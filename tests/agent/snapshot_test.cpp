// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/state/snapshot.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/store/memory_disk.hpp"
#include "core/store/sections.hpp"
#include "core/time/random.hpp"
#include "robot_agent/state/restored.hpp"

namespace adit::agent {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Id id_of(char c) {
  Id id{};
  id.fill(static_cast<std::uint8_t>(c));
  return id;
}

nav::Area area_of(const std::string& name, std::size_t corners) {
  nav::Area area{.name = name, .kind = nav::AreaKind::keep_out, .z_max = 4.5, .weight = 2.5};
  for (std::size_t i = 0; i < corners; ++i) {
    const double bearing = 2 * M_PI * static_cast<double>(i) / static_cast<double>(corners);
    area.corners.emplace_back(20 * std::cos(bearing), 20 * std::sin(bearing));
  }
  return area;
}

Snapshot full() {
  Snapshot s;
  s.authority = {{77, 12},
                 Party{"op1", id_of('a')},
                 Binding::Stored{{1, 2, 3}, wire::ParticipantId{4, 5, 6}, wire::ParticipantId{7, 8}},
                 true,
                 {{"op2", id_of('b')}, {"others", Id{}}}};
  s.behaviour = {"waypoint", Reason::stopped, true, false, 9, {1.5, -2, 0.25}, true};
  EXPECT_TRUE(s.behaviour.areas.add(area_of("shaft", 5)));
  s.boot = 0x1122334455667788;
  s.battery = 2;
  s.place = StoredFrames{
      {4, -3, 1.5}, 2,   OdometrySample{Pose3::level({7, 8, -2}, 0.5), 1234567890123, from_stamp(987654321)},
      3.5,          41,  Pose3::level({0.1, -0.2, 0.01}, 0),
      false,        0.8, 0.01};
  StoredAnswers a;
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
  s.behaviour.areas = {};
  for (int i = 10; i < 26; ++i)
    EXPECT_TRUE(s.behaviour.areas.add(area_of(std::string(30, 'a') + std::to_string(i), 16)));
  return s;
}

Snapshot read_back(const Snapshot& s) {
  const auto read = decode_snapshot(encode(s));
  EXPECT_TRUE(read);
  if (!read) return {};
  EXPECT_THAT(read->lost, IsEmpty());
  EXPECT_TRUE(read->safe());
  return read->snapshot;
}

TEST(Snapshot, gives_back_what_was_put) {
  EXPECT_EQ(read_back(full()), full());
  EXPECT_EQ(read_back(largest()), largest());
  EXPECT_EQ(read_back(Snapshot{}), Snapshot{});
}

TEST(Snapshot, of_an_earlier_version_does_not_know_its_accuracy) {
  Snapshot s = full();
  auto sections = store::unpack_sections(encode(s)).good;
  EXPECT_EQ(std::erase_if(sections, [](const auto& each) { return store::tag_text(each.tag) == "SIGM"; }),
            1u);
  const auto read = decode_snapshot(store::pack_sections(sections));
  ASSERT_TRUE(read);
  EXPECT_THAT(read->lost, IsEmpty());
  s.place->pose_sigma.reset();
  s.place->yaw_sigma = 0;
  EXPECT_EQ(read->snapshot, s);
}

TEST(Snapshot, gives_back_what_the_modes_stored) {
  Snapshot s = largest();
  for (const char* mode : {"a", "b", "c", "d", "e", "f", "g", "orbit"})
    s.behaviour.modes.push_back({mode, store::Bytes(Snapshot::kModeBytes, 7)});
  EXPECT_EQ(read_back(s), s);
  ASSERT_TRUE(read_back(s).behaviour.of("orbit"));
  EXPECT_FALSE(read_back(s).behaviour.of("hold"));
  s.behaviour.modes.push_back({"one_too_many", {1}});
  s.behaviour.modes.front().bytes.resize(Snapshot::kModeBytes + 1);
  const Snapshot back = read_back(s);
  EXPECT_EQ(back.behaviour.modes.size(), Snapshot::kModes);
  EXPECT_FALSE(back.behaviour.of("a")) << "too long: the module starts without it";
}

TEST(Snapshot, is_bounded) {
  EXPECT_LE(encode(largest()).size(), kSnapshotFormat.max_bytes);
  Snapshot beyond = largest();
  beyond.authority.stops.resize(40, {"op9", Id{}});
  beyond.answers.resize(100, beyond.answers.front());
  for (StoredAnswers& a : beyond.answers) a.answers.resize(50, {2, Reason::none, std::string(5000, 'x')});
  EXPECT_LE(encode(beyond).size(), kSnapshotFormat.max_bytes);
  const Snapshot back = read_back(beyond);
  ASSERT_EQ(back.authority.stops.size(), 16u);
  EXPECT_EQ(back.authority.stops.back().name, "others") << "the stops that have no place stay as one";
  EXPECT_EQ(back.answers.size(), 8u);
}

std::string hostile_text(Random& random) {
  // Mostly about the bounds; a few are longer than the 65535 bytes that a length field can say.
  std::string text(random.chance(0.001) ? 65'530 + random.below(20) : random.below(80), '\0');
  for (char& c : text) c = random.chance(0.5) ? 'a' : static_cast<char>(random.next());
  return text;
}

double hostile_number(Random& random) {
  const double numbers[] = {0, 1.5, -1e300, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()};
  return numbers[random.below(5)];
}

Snapshot hostile(Random& random) {
  Snapshot s;
  const auto party = [&] { return Party{hostile_text(random), id_of(static_cast<char>(random.next()))}; };
  s.authority.epoch = {random.next(), static_cast<std::uint32_t>(random.next())};
  if (random.chance(0.7)) s.authority.holder = party();
  if (random.chance(0.5)) s.authority.speaker = Binding::Stored{{1}, std::nullopt, wire::ParticipantId{2}};
  s.authority.locked = random.chance(0.5);
  for (std::uint64_t n = random.below(30); n > 0; --n) s.authority.stops.push_back(party());
  s.behaviour = {hostile_text(random),
                 static_cast<Reason>(random.next()),
                 random.chance(0.5),
                 random.chance(0.5),
                 static_cast<std::uint32_t>(random.next()),
                 {hostile_number(random), hostile_number(random), hostile_number(random)},
                 random.chance(0.5)};
  for (std::uint64_t n = random.below(20); n > 0; --n) {
    nav::Area area{.name = hostile_text(random), .kind = static_cast<nav::AreaKind>(random.below(5))};
    if (random.chance(0.5)) area = area_of("a" + std::to_string(n), 3 + random.below(20));
    if (random.chance(0.5)) area.corners.emplace_back(hostile_number(random), hostile_number(random));
    if (random.chance(0.3)) area.z_min = hostile_number(random);
    (void)s.behaviour.areas.add(area);
  }
  for (std::uint64_t n = random.below(12); n > 0; --n)
    s.behaviour.modes.push_back(
        {random.chance(0.5) ? "orbit" : hostile_text(random), store::Bytes(random.below(600), 7)});
  if (random.chance(0.7)) {
    s.place.emplace();
    s.place->T_map_odom = {hostile_number(random), 1.0, hostile_number(random)};
    s.place->newest.emplace();
    s.place->newest->T_odom_base.position.x() = hostile_number(random);
    s.place->newest->T_odom_base.orientation.w() = hostile_number(random);
  }
  s.boot = random.next();
  s.battery = static_cast<std::uint8_t>(random.next());
  for (std::uint64_t n = random.below(20); n > 0; --n) {
    StoredAnswers a;
    a.station = hostile_text(random);
    a.newest = random.chance(0.5) ? random.next() : random.below(5);
    a.floor = random.next();
    for (std::uint64_t k = random.below(20); k > 0; --k)
      a.answers.push_back({random.below(8), static_cast<Reason>(random.next()), hostile_text(random)});
    s.answers.push_back(std::move(a));
  }
  return s;
}

TEST(Snapshot, of_hostile_input_is_read_back_completely) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Snapshot s = hostile(random);
    EXPECT_LE(encode(s).size(), kSnapshotFormat.max_bytes);
    const Snapshot back = read_back(s);
    EXPECT_EQ(back, sanitized(s));
    EXPECT_EQ(back.authority.stops.empty(), s.authority.stops.empty()) << "no stop is lost";
  }
}

TEST(Snapshot, loses_one_section_alone_to_one_damaged_byte) {
  const Snapshot intact = full();
  const store::Bytes bytes = encode(intact);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    store::Bytes bent = bytes;
    bent[at] ^= 0x41;
    const auto read = decode_snapshot(bent);
    ASSERT_TRUE(read) << at;
    ASSERT_LE(read->lost.size(), 1u) << at;
    const Snapshot& s = read->snapshot;
    int differ = (s.behaviour != intact.behaviour) + (s.answers != intact.answers) +
                 (s.boot != intact.boot || s.battery != intact.battery);
    differ += read->authority_lost ? s.authority.holder == std::nullopt
                                   : s.authority.holder != intact.authority.holder;
    differ += s.authority.stops != intact.authority.stops;
    differ += s.place != intact.place;
    EXPECT_EQ(differ, static_cast<int>(read->lost.size())) << at;
  }
}

TEST(Snapshot, with_an_invalid_place_has_no_odometry) {
  Snapshot s = full();
  s.place->newest->T_odom_base.orientation.w() = 7;
  EXPECT_FALSE(sanitized(s).place->newest);
  s = full();
  s.place->T_map_odom.x = std::nan("");
  EXPECT_EQ(sanitized(s).place, StoredFrames{});
}

TEST(Snapshot, without_its_stops_counts_as_stopped) {
  const store::Bytes payload = encode(full());
  auto list = store::unpack_sections(payload);
  std::erase_if(list.good, [](const store::Section& s) { return store::tag_text(s.tag) == "STOP"; });
  const auto read = decode_snapshot(store::pack_sections(list.good));
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->stops_lost);
  EXPECT_FALSE(read->safe());
  EXPECT_THAT(read->lost, ElementsAre("stops"));
  ASSERT_EQ(read->snapshot.authority.stops.size(), 1u);
  EXPECT_EQ(read->snapshot.authority.stops.front().name, "others");
  EXPECT_EQ(read->snapshot.authority.holder, full().authority.holder);
}

TEST(Snapshot, without_one_of_its_areas_is_not_safe) {
  auto list = store::unpack_sections(encode(full()));
  const auto at = std::find_if(list.good.begin(), list.good.end(), [](const store::Section& section) {
    return section.tag == store::SectionTag{'A', 'R', 'E', 'A'};
  });
  ASSERT_NE(at, list.good.end());
  at->payload.back() ^= 1;  // A corner that is no place any more.
  const auto read = decode_snapshot(store::pack_sections(list.good));
  ASSERT_TRUE(read);
  EXPECT_THAT(read->lost, ElementsAre("an area"));
  EXPECT_FALSE(read->safe()) << "it is not known where the robot may drive";
}

TEST(Snapshot, skips_sections_that_it_does_not_know) {
  auto list = store::unpack_sections(encode(full()));
  list.good.push_back({{'C', 'O', 'N', 'V'}, 1, {1, 2, 3}});
  auto read = decode_snapshot(store::pack_sections(list.good));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->snapshot, full());
  EXPECT_THAT(read->lost, IsEmpty());
  EXPECT_THAT(read->unknown, ElementsAre("section CONV"));

  for (const std::uint16_t version : {0, 9}) {
    for (store::Section& section : list.good)
      if (store::tag_text(section.tag) == "BEHV") section.version = version;
    read = decode_snapshot(store::pack_sections(list.good));
    ASSERT_TRUE(read);
    EXPECT_THAT(read->lost, ElementsAre("mode and goal")) << version;
    EXPECT_EQ(read->snapshot.authority, full().authority);
    EXPECT_EQ(read->snapshot.behaviour.mode, "hold");
  }
}

TEST(Snapshot, takes_any_bytes) {
  Random random(3);
  const store::Bytes intact = encode(largest());
  for (int i = 0; i < 1000; ++i) {
    store::Bytes junk = intact;
    for (std::uint64_t edits = 1 + random.below(5); edits > 0; --edits)
      junk[random.below(junk.size())] = static_cast<std::uint8_t>(random.next());
    if (random.chance(0.3)) junk.resize(random.below(junk.size()));
    const auto read = decode_snapshot(junk);
    if (!read) continue;
    EXPECT_EQ(sanitized(read->snapshot), read->snapshot);
    EXPECT_LE(encode(read->snapshot).size(), kSnapshotFormat.max_bytes);
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
  EXPECT_FALSE(r.damaged);
  EXPECT_EQ(r.text, "");
  EXPECT_EQ(r.snapshot, full());
  EXPECT_EQ(r.generation, 5u);
}

TEST_F(RestoreTest, NothingIsAFirstStart) {
  EXPECT_FALSE(restore_state(disk).lost);
  EXPECT_FALSE(restore_state(disk).snapshot);
  EXPECT_FALSE(restore_state(nullptr).lost);
}

TEST_F(RestoreTest, AStateThatDisappearedIsLost) {
  ASSERT_TRUE(disk->replace(kMarkerFile, {}).ok());
  EXPECT_TRUE(restore_state(disk).lost);
}

TEST_F(RestoreTest, AnUnusableStateIsLostWithItsReason) {
  const auto lost = [&](const store::Bytes& bytes) {
    disk->plant(kStateFile, bytes);
    const Restored r = restore_state(disk);
    EXPECT_TRUE(r.lost);
    EXPECT_FALSE(r.snapshot);
    EXPECT_EQ(disk->read(r.preserved).value(), bytes) << "preserved as " << r.preserved;
    return r.text;
  };
  EXPECT_THAT(lost({}), HasSubstr("torn"));
  EXPECT_THAT(lost(store::encode_envelope(kSnapshotFormat, 5, store::Bytes(30, 9))), HasSubstr("corrupt"));
  store::StateFormat format = kSnapshotFormat;
  format.version = 0;
  EXPECT_THAT(lost(store::encode_envelope(format, 5, encode(full()))), HasSubstr("older"));
  format.version = 9;
  EXPECT_THAT(lost(store::encode_envelope(format, 5, encode(full()))), HasSubstr("newer"));
  EXPECT_THAT(lost(store::Bytes(50, 'x')), HasSubstr("foreign"));
  EXPECT_THAT(lost(store::Bytes(1'000'000, 'x')), HasSubstr("unreadable"));
}

TEST_F(RestoreTest, AFileOfANewerVersionIsNeverDeleted) {
  store::StateFormat newer = kSnapshotFormat;
  newer.version = 9;
  for (std::uint8_t i = 1; i <= 3; ++i) {
    disk->plant(kStateFile, store::encode_envelope(newer, i, store::Bytes{i}));
    EXPECT_TRUE(restore_state(disk).lost);
    ASSERT_TRUE(save(full()).ok());
  }
  EXPECT_EQ(disk->read("state.newer").value(), store::encode_envelope(newer, 1, store::Bytes{1}));
  EXPECT_EQ(disk->read("state.newer-2").value(), store::encode_envelope(newer, 2, store::Bytes{2}));
  EXPECT_EQ(disk->read("state.newer-3").value(), store::encode_envelope(newer, 3, store::Bytes{3}));
  for (int i = 0; i < 20; ++i) {
    disk->plant(kStateFile, store::encode_envelope(newer, 4, {}));
    (void)restore_state(disk);
  }
  EXPECT_EQ(disk->list().value().size(), 8u) << "what is preserved is bounded";
}

TEST_F(RestoreTest, ADamagedByteAnywhereInTheFileLosesOneEntryAtMost) {
  const store::Bytes intact = store::encode_envelope(kSnapshotFormat, 5, encode(full()));
  for (std::size_t at = 0; at < intact.size(); ++at) {
    disk = std::make_shared<store::MemoryDisk>();
    store::Bytes bent = intact;
    bent[at] ^= 0x20;
    disk->plant(kStateFile, bent);
    const Restored r = restore_state(disk);
    ASSERT_TRUE(r.snapshot) << at << ": " << r.text;
    EXPECT_TRUE(r.damaged && !r.text.empty()) << at;
    EXPECT_EQ(std::count(r.text.begin(), r.text.end(), ','),
              r.text.find("every") == std::string::npos ? 0 : 1)
        << r.text;
    EXPECT_EQ(disk->read(r.preserved).value(), bent);
    const auto lost = [&r](const char* entry) { return r.text.find(entry) != std::string::npos; };
    EXPECT_EQ(r.hold, lost("stops") || lost("authority") || lost("an area"));
  }
}

TEST_F(RestoreTest, ATornFileGivesItsIntactSections) {
  const store::Bytes intact = store::encode_envelope(kSnapshotFormat, 5, encode(full()));
  std::size_t used = 0;
  for (std::size_t size = 0; size < intact.size(); ++size) {
    disk->plant(kStateFile, {intact.begin(), intact.begin() + static_cast<std::ptrdiff_t>(size)});
    const Restored r = restore_state(disk);
    EXPECT_THAT(r.text, HasSubstr("torn"));
    EXPECT_NE(r.lost, r.snapshot.has_value());
    used += r.snapshot ? 1u : 0u;
    if (r.snapshot && !r.hold) {
      EXPECT_EQ(r.snapshot->authority, full().authority);
    }
  }
  EXPECT_GT(used, 100u);
}

TEST_F(RestoreTest, TheIdentityIsDrawnOnceAndStored) {
  EXPECT_EQ(restore_identity(disk, id_of('x')), id_of('x'));
  EXPECT_EQ(restore_identity(disk, id_of('y')), id_of('x'));
  disk->plant(kIdentityFile, store::Bytes(10, 1));
  EXPECT_EQ(restore_identity(disk, id_of('z')), id_of('z')) << "one that cannot be read is drawn anew";
  EXPECT_EQ(restore_identity(disk, id_of('y')), id_of('z'));
  EXPECT_EQ(restore_identity(nullptr, id_of('y')), id_of('y'));
}

}  // namespace
}  // namespace adit::agent

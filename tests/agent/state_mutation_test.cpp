// SPDX-License-Identifier: Apache-2.0
// Files of state and findings whose bytes were changed: reading them never crashes and never allocates
// without bound, and what it gives could have been written. ADIT_MUTATIONS sets the number of files per test.
#include <gmock/gmock.h>

#include <cstdlib>

#include "core/findings/finding.hpp"
#include "core/store/sections.hpp"
#include "core/time/random.hpp"
#include "robot_agent/state/snapshot.hpp"
#include "tests/findings/some.hpp"
#include "tests/wire/largest_allocation.hpp"

namespace adit::agent {
namespace {

using store::Bytes;

std::size_t mutations() {
  const char* text = std::getenv("ADIT_MUTATIONS");
  return text ? std::strtoull(text, nullptr, 10) : 4000;
}

/// Changes as a failing device makes them, and numbers that parsers get wrong.
Bytes mutated(Bytes bytes, Random& random) {
  constexpr std::uint8_t odd[] = {0x00, 0x01, 0x7f, 0x80, 0xfe, 0xff};
  for (std::uint64_t edits = 1 + random.below(6); edits > 0 && !bytes.empty(); --edits) {
    const std::size_t at = random.below(bytes.size());
    const std::size_t length = std::min<std::size_t>(1 + random.below(16), bytes.size() - at);
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random.below(7)) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u << random.below(8)));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(random.next());
        break;
      case 2:
        std::fill_n(first, std::min<std::size_t>(length, 8), odd[random.below(6)]);
        break;
      case 3:
        bytes.resize(at);
        break;
      case 4:
        bytes.erase(first, first + static_cast<std::ptrdiff_t>(length));
        break;
      case 5: {
        const Bytes copy(first, first + static_cast<std::ptrdiff_t>(length));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(random.below(bytes.size())), copy.begin(),
                     copy.end());
        break;
      }
      default:
        bytes.insert(bytes.end(), random.below(64), odd[random.below(6)]);
    }
  }
  return bytes;
}

Snapshot some_state() {
  Snapshot s;
  s.authority = {{77, 12},
                 Party{"op1", {}},
                 Binding::Stored{{1}, {}, wire::ParticipantId{2}},
                 true,
                 {{"op2", {}}, {"op3", {}}}};
  s.behaviour.goal_known = true;
  for (const char* name : {"west", "shaft"})
    (void)s.behaviour.areas.add(
        nav::checked({.name = name, .kind = nav::AreaKind::keep_out, .corners = {{1, 2}, {3, 4}}}).value());
  s.boot = 5;
  StoredAnswers a;
  a.station = "op1";
  a.newest = 12;
  a.answers = {{11, Reason::none, ""}, {12, Reason::locked, "locked by op2"}};
  s.answers = {a, a, a};
  return s;
}

/// Checks what came of reading `size` bytes.
void check(const std::optional<ReadSnapshot>& read, std::size_t size) {
  ASSERT_LE(wire::largest_allocation, 4096 + 4 * size);
  if (!read) return;
  ASSERT_EQ(sanitized(read->snapshot), read->snapshot);
  const auto again = decode_snapshot(encode(read->snapshot));
  ASSERT_TRUE(again && again->lost.empty());
  ASSERT_EQ(again->snapshot, read->snapshot);
}

TEST(StateMutation, AnyBytesInAFile) {
  Random random(1);
  const Bytes intact = store::encode_envelope(kSnapshotFormat, 5, encode(some_state()));
  for (std::size_t i = mutations(); i > 0; --i) {
    const Bytes bytes = mutated(intact, random);
    wire::largest_allocation = 0;
    const store::State state = store::decode_envelope(kSnapshotFormat, bytes);
    const auto read = decode_snapshot(state.found == store::LoadStatus::good ? state.payload : state.remains);
    check(read, bytes.size());
    if (testing::Test::HasFatalFailure()) FAIL() << "mutation " << i;
  }
}

// The checksums are right: the content is what no robot wrote.
TEST(StateMutation, AnyBytesInASection) {
  Random random(2);
  const auto list = store::unpack_sections(encode(some_state()));
  for (std::size_t i = mutations(); i > 0; --i) {
    auto sections = list.good;
    for (store::Section& section : sections)
      if (random.chance(0.4)) section.payload = mutated(std::move(section.payload), random);
    if (random.chance(0.2)) sections.push_back(sections[random.below(sections.size())]);
    if (random.chance(0.2))
      sections[random.below(sections.size())].version = static_cast<std::uint16_t>(random.below(3));
    const Bytes bytes = store::pack_sections(sections);
    wire::largest_allocation = 0;
    const auto read = decode_snapshot(bytes);
    ASSERT_TRUE(read);
    check(read, bytes.size());
    if (testing::Test::HasFatalFailure()) FAIL() << "mutation " << i;
  }
}

TEST(StateMutation, AnyBytesOfAFinding) {
  constexpr store::StateFormat format{{'F', 'I', 'N', 'D'}, 1, 1024};
  Random random(4);
  const Bytes intact = findings::to_file(findings::some(7));
  const Bytes payload = store::decode_envelope(format, intact).payload;
  for (std::size_t i = mutations(); i > 0; --i) {
    // Every second one with a checksum that is right.
    const Bytes bytes =
        i % 2 == 0 ? mutated(intact, random) : store::encode_envelope(format, 0, mutated(payload, random));
    wire::largest_allocation = 0;
    const findings::FindingFile file = findings::read_finding(bytes);
    ASSERT_LE(wire::largest_allocation, 4096 + 4 * bytes.size());
    ASSERT_EQ(file.finding.has_value(), file.found == store::LoadStatus::good);
    if (file.finding) {
      ASSERT_TRUE(findings::valid(*file.finding));
      ASSERT_EQ(findings::from_file(findings::to_file(*file.finding)), file.finding);
    }
  }
}

}  // namespace
}  // namespace adit::agent

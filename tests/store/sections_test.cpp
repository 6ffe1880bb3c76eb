// SPDX-License-Identifier: Apache-2.0
#include "core/store/sections.hpp"

#include <gmock/gmock.h>

#include "core/time/random.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::store {
namespace {

using testing::IsEmpty;

std::vector<Section> three() {
  return {{{'O', 'N', 'E', '1'}, 1, bytes("first")},
          {{'T', 'W', 'O', '2'}, 7, {}},
          {{'T', 'R', 'E', 'E'}, 1, Bytes(300, 3)}};
}

TEST(Sections, give_back_what_was_packed) {
  const auto list = unpack_sections(pack_sections(three()));
  EXPECT_TRUE(list.readable);
  EXPECT_EQ(list.good, three());
  EXPECT_THAT(list.damaged, IsEmpty());
  EXPECT_TRUE(unpack_sections(pack_sections({})).readable);
  EXPECT_FALSE(unpack_sections({}).readable);
}

TEST(Sections, lose_one_to_a_damaged_byte) {
  const Bytes complete = pack_sections(three());
  for (std::size_t at = 0; at < complete.size(); ++at) {
    Bytes bent = complete;
    bent[at] ^= 1;
    const auto list = unpack_sections(bent);
    ASSERT_TRUE(list.readable) << at;
    EXPECT_EQ(list.good.size() + list.damaged.size(), 3u) << at;
    EXPECT_LE(list.damaged.size(), 1u) << at;
    for (const Section& section : list.damaged) EXPECT_TRUE(section.payload.empty());
  }
}

TEST(Sections, lose_the_end_to_a_file_that_ends_early) {
  const Bytes complete = pack_sections(three());
  for (std::size_t size = 0; size < complete.size(); ++size) {
    const auto list = unpack_sections(std::span(complete).first(size));
    if (list.readable) {
      EXPECT_EQ(list.good.size() + list.damaged.size(), 3u);
      EXPECT_FALSE(list.damaged.empty());
    }
  }
}

TEST(Sections, are_bounded) {
  const std::vector<Section> many(kMaxSections + 9, three().front());
  EXPECT_EQ(unpack_sections(pack_sections(many)).good.size(), kMaxSections);
}

TEST(Sections, take_any_bytes) {
  Random random(5);
  const Bytes complete = pack_sections(three());
  for (int i = 0; i < 5000; ++i) {
    Bytes junk = random.chance(0.8) ? complete : Bytes(random.below(300));
    for (std::uint64_t edits = 1 + random.below(6); edits > 0 && !junk.empty(); --edits)
      junk[random.below(junk.size())] = static_cast<std::uint8_t>(random.next());
    if (random.chance(0.3)) junk.resize(random.below(junk.size() + 20));
    const auto list = unpack_sections(junk);
    std::size_t total = 0;
    for (const Section& section : list.good) total += section.payload.size();
    EXPECT_LE(total, junk.size());
  }
}

}  // namespace
}  // namespace adit::store

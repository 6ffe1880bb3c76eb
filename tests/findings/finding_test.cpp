// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/time/random.hpp"
#include "tests/findings/some.hpp"

namespace adit::findings {
namespace {

TEST(Finding, ComesBackFromItsFile) {
  EXPECT_EQ(from_file(to_file(some(7))), some(7));
  Finding largest = some(std::numeric_limits<std::uint64_t>::max());
  largest.key.robot = std::string(32, 'r');
  largest.key.owner.fill(0xab);
  largest.kind = std::string(32, 'k');
  largest.text = std::string(128, 't');
  largest.data.assign(400, 9);
  EXPECT_EQ(from_file(to_file(largest)), largest);
  EXPECT_LE(to_file(largest).size(), 1024u);
  EXPECT_TRUE(store::valid_file_name(file_name(largest.key) + ".aside")) << file_name(largest.key);
  Finding smallest = some(1);
  smallest.text.clear();
  smallest.data.clear();
  EXPECT_EQ(from_file(to_file(smallest)), smallest);
}

TEST(Finding, ComesBackFromItsFileWithItsRevision) {
  Finding f = some(7);
  f.revision = std::numeric_limits<std::uint32_t>::max();
  f.withdrawn = true;
  EXPECT_EQ(from_file(to_file(f)), f);
}

TEST(Finding, OfAFileOfVersion1WasNeverChanged) {
  const FindingFile file = read_finding(file_of_version(1, some(7)));
  EXPECT_EQ(file.found, store::LoadStatus::good);
  EXPECT_EQ(file.finding, some(7));
  EXPECT_EQ(read_finding(store::encode_envelope({{'F', 'I', 'N', 'D'}, 0, 1024}, 0, store::Bytes(9))).found,
            store::LoadStatus::older);
}

TEST(Finding, OfAFileOfVersion2HasNoOwner) {
  Finding f = some(7);
  f.revision = 3;
  f.withdrawn = true;
  const FindingFile file = read_finding(file_of_version(2, f));
  EXPECT_EQ(file.found, store::LoadStatus::good);
  EXPECT_EQ(file.finding, f);
}

Finding owned() {
  Finding f = some(7);
  for (std::size_t i = 0; i < f.key.owner.size(); ++i) f.key.owner[i] = static_cast<std::uint8_t>(16 * i + 1);
  f.anchor = {5, 6, {1.0f, 2.0f, -3.0f}, 0.5f};
  f.photo = {77, 2000, 800};
  return f;
}

TEST(Finding, ComesBackFromItsFileWithOwnerAnchorAndPhoto) {
  EXPECT_EQ(from_file(to_file(owned())), owned());
}

TEST(Finding, HasTheNameOfItsOwnerInItsFile) {
  EXPECT_EQ(file_name(owned().key), "finding-r1-0000000000000007-01112131415161718191a1b1c1d1e1f1");
  Owner owner{};
  EXPECT_TRUE(read_owner(owner_text(owned().key.owner), owner));
  EXPECT_EQ(owner, owned().key.owner);
  EXPECT_TRUE(read_owner("", owner));
  EXPECT_EQ(owner, Owner{});
  for (const char* text : {"1", "01112131415161718191a1b1c1d1e1f", "01112131415161718191a1b1c1d1e1f1f",
                           "0x112131415161718191a1b1c1d1e1f1", "-1112131415161718191a1b1c1d1e1f1"})
    EXPECT_FALSE(read_owner(text, owner)) << text;
}

TEST(Finding, HasTheSameContentInAnyRevision) {
  Finding f = some(7);
  f.revision = 4;
  EXPECT_TRUE(same_content(f, some(7)));
  f.anchor = {5, 6, {1.0f, 2.0f, -3.0f}, 0.5f};
  EXPECT_TRUE(same_content(f, some(7))) << "the same place in another submap";
  f.withdrawn = true;
  EXPECT_FALSE(same_content(f, some(7)));
}

TEST(Finding, HasAFileOfItsOwn) {
  EXPECT_EQ(file_name({"r1", 0x1f}), "finding-r1-000000000000001f");
  EXPECT_NE(file_name({"r1", 1}), file_name({"r2", 1}));
  EXPECT_TRUE(is_finding_file(file_name({"r1", 1})));
  EXPECT_FALSE(is_finding_file("findings-known"));
  EXPECT_FALSE(is_finding_file("state"));
}

TEST(Finding, ThatIsOutOfBoundsIsNone) {
  EXPECT_TRUE(valid(some(1)));
  EXPECT_FALSE(valid(some(0)));
  EXPECT_FALSE(valid(some(1, 1, "")));
  EXPECT_FALSE(valid(some(1, 1, "../r1")));
  EXPECT_FALSE(valid(some(1, 1, std::string(33, 'r'))));
  Finding f = some(1);
  f.kind.clear();
  EXPECT_FALSE(valid(f));
  f = some(1);
  f.text = std::string(129, 'x');
  EXPECT_FALSE(valid(f));
  f = some(1);
  f.data.resize(401);
  EXPECT_FALSE(valid(f));
  f = some(1);
  f.position[1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(valid(f));
  EXPECT_FALSE(from_file(to_file(f))) << "not from a file either";
}

TEST(Finding, TakesAnyBytes) {
  Random random(1);
  const store::Bytes complete = to_file(some(7));
  for (int i = 0; i < 3000; ++i) {
    store::Bytes junk = complete;
    for (std::uint64_t edits = 1 + random.below(3); edits > 0; --edits)
      junk[random.below(junk.size())] = static_cast<std::uint8_t>(random.next());
    if (random.chance(0.3)) junk.resize(random.below(junk.size()));
    const auto back = from_file(junk);
    EXPECT_TRUE(!back || *back == some(7));
  }
}

}  // namespace
}  // namespace adit::findings

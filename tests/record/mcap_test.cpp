// SPDX-License-Identifier: Apache-2.0
// The MCAP writer and reader against each other; tests/record/reader has somebody else's.
#include "core/record/compress.hpp"
#include "core/time/random.hpp"
#include "tests/record/small.hpp"

namespace adit::record {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Mcap, CrcIsThatOfZlib) {
  EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926U) << "the check value of CRC-32";
  const std::string text = "a text that is longer than eight bytes by some";
  EXPECT_EQ(crc32(bytes_of(text.substr(11)), crc32(bytes_of(text.substr(0, 11)))), crc32(bytes_of(text)));
}

class Packed : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Mcap, Packed, testing::Bool());

TEST_P(Packed, ReadsWhatWasWritten) {
  const auto heard = hear(small_file(GetParam()));
  ASSERT_TRUE(heard) << heard.error().text;
  EXPECT_TRUE(heard->report.complete) << heard->report.trouble;
  const std::string first = "first " + std::string(40, 'x');
  EXPECT_THAT(heard->messages, ElementsAre("1:/a 0 " + first, "1:/a 1 second", "1:/a 10 " + first,
                                           "1:/a 11 second", "0:/b 30 third", "1:/a 25 "));
  EXPECT_EQ(heard->report.chunks, 3U);
  EXPECT_EQ(heard->report.first, 0U);
  EXPECT_EQ(heard->report.last, 30U);
  EXPECT_EQ(heard->metadata.at("about").at("robot"), "r1");
  EXPECT_EQ(heard->schemas.at(1).name, "x::Y");
  ASSERT_EQ(heard->channels.size(), 2U);
  EXPECT_EQ(heard->channels[0].metadata.at("from"), "r1");
}

TEST_P(Packed, ReadsAllCompleteChunksBeforeATear) {
  const std::vector<std::uint8_t> file = small_file(GetParam());
  const std::vector<std::string> all = hear(file)->messages;
  std::size_t before = 0;
  for (std::size_t size = 0; size < file.size(); ++size) {
    const auto heard = hear(ByteSpan(file).first(size));
    if (size < kMcapMagic.size()) {
      ASSERT_FALSE(heard) << size;
      continue;
    }
    ASSERT_TRUE(heard) << size;
    ASSERT_FALSE(heard->report.complete) << size;
    ASSERT_THAT(heard->report.trouble, HasSubstr("torn off")) << size;
    ASSERT_EQ(heard->messages.size() % 2, 0U) << "two in a chunk";
    ASSERT_GE(heard->messages.size(), before) << size;
    ASSERT_TRUE(std::equal(heard->messages.begin(), heard->messages.end(), all.begin())) << size;
    before = heard->messages.size();
  }
  EXPECT_EQ(before, all.size());
}

TEST_P(Packed, AChangedByteIsNoticedAndAtMostItsRecordIsLost) {
  const std::vector<std::uint8_t> file = small_file(GetParam());
  const std::vector<std::string> all = hear(file)->messages;
  for (std::size_t at = kMcapMagic.size(); at < file.size(); ++at) {
    std::vector<std::uint8_t> changed = file;
    changed[at] ^= 0x10;
    const auto heard = hear(changed);
    ASSERT_TRUE(heard) << at;
    ASSERT_FALSE(heard->report.complete) << "byte " << at << " changed and nobody saw";
  }
}

TEST(Mcap, ADamagedChunkIsLeftOutAlone) {
  std::vector<std::uint8_t> file = small_file(false);
  const std::string bytes(file.begin(), file.end());
  file[bytes.find("second")] = 'S';  // in the first chunk
  const auto heard = hear(file);
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->report.bad_chunks, 1U);
  EXPECT_EQ(heard->messages.size(), 4U);
  EXPECT_THAT(heard->report.trouble, HasSubstr("damaged chunk"));
}

TEST(Mcap, WithoutASummaryEverythingIsThere) {
  const auto heard = hear(small_file(true, false));
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->messages.size(), 6U);
  EXPECT_FALSE(heard->report.complete);
}

TEST(Mcap, RandomBytesAreReadWithoutHarm) {
  Random random(5);
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> file =
        round % 2 == 0 ? small_file(round % 4 == 0) : std::vector<std::uint8_t>{};
    if (file.empty()) {
      file.assign(kMcapMagic.begin(), kMcapMagic.end());
      for (std::uint64_t n = random.next() % 300; n > 0; --n) {
        file.push_back(static_cast<std::uint8_t>(random.next() % 16));
        if (random.next() % 3 == 0) file.insert(file.end(), 7, 0);
      }
    } else {
      for (int n = 0; n < 6; ++n)
        file[8 + random.next() % (file.size() - 8)] = static_cast<std::uint8_t>(random.next());
    }
    ASSERT_TRUE(hear(file)) << round;
  }
}

TEST(Mcap, NoRecordingAtAllIsAnError) {
  for (const std::string text : {"", "no recording", "\x89MCAP1\r\n and more"})
    EXPECT_EQ(hear(bytes_of(text)).reason(), Reason::syntax) << text;
}

TEST(Mcap, AChannelThatThereIsNotIsRefused) {
  MemoryOutput out;
  McapWriter writer(out, {});
  EXPECT_EQ(writer.write(3, 0, {}).reason(), Reason::out_of_range);
}

TEST(Mcap, AChunkThatPromisesTooMuchIsLeftOut) {
  if (!can_compress()) GTEST_SKIP() << "no libzstd";
  std::vector<std::uint8_t> packed, out;
  ASSERT_TRUE(compress(std::vector<std::uint8_t>(10'000, 7), packed));
  EXPECT_TRUE(decompress(packed, 10'000, out));
  EXPECT_FALSE(decompress(packed, 9'999, out));
  EXPECT_FALSE(decompress(packed, 50'000'000'000, out));
  packed.resize(packed.size() - 1);
  EXPECT_FALSE(decompress(packed, 10'000, out));
}

}  // namespace
}  // namespace adit::record

// SPDX-License-Identifier: Apache-2.0
#include "core/store/pack.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/store/crc32c.hpp"
#include "core/time/random.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::store {
namespace {

TEST(Crc32c, gives_the_published_values) {
  EXPECT_EQ(crc32c(bytes("123456789")), 0xe3069283u);
  EXPECT_EQ(crc32c(Bytes(32, 0x00)), 0x8a9136aau);  // RFC 3720, B.4
  EXPECT_EQ(crc32c(Bytes(32, 0xff)), 0x62a8ab43u);
  EXPECT_EQ(crc32c({}), 0u);
  EXPECT_EQ(crc32c(bytes("6789"), crc32c(bytes("12345"))), 0xe3069283u) << "continued";
}

TEST(Pack, gives_back_what_was_put) {
  Packer out;
  out.put(std::uint8_t{7}).put(std::uint16_t{0x1234}).put(std::uint32_t{0x89abcdef});
  out.put(std::uint64_t{0xfedcba9876543210}).flag(true).flag(false).put(-1.5).text("robot");
  out.put(std::array<std::uint8_t, 3>{1, 2, 3}).put(std::numeric_limits<double>::quiet_NaN());
  Unpacker in(out.bytes());
  EXPECT_EQ(in.get<std::uint8_t>(), 7);
  EXPECT_EQ(in.get<std::uint16_t>(), 0x1234);
  EXPECT_EQ(in.get<std::uint32_t>(), 0x89abcdefu);
  EXPECT_EQ(in.get<std::uint64_t>(), 0xfedcba9876543210u);
  EXPECT_TRUE(in.flag());
  EXPECT_FALSE(in.flag());
  EXPECT_EQ(in.number(), -1.5);
  EXPECT_EQ(in.text(5), "robot");
  EXPECT_EQ(in.array<3>(), (std::array<std::uint8_t, 3>{1, 2, 3}));
  EXPECT_FALSE(in.done());
  EXPECT_TRUE(std::isnan(in.number()));
  EXPECT_TRUE(in.done());
}

TEST(Pack, is_little_endian_without_padding) {
  EXPECT_EQ(Packer{}.put(std::uint8_t{1}).put(std::uint32_t{0x05040302}).bytes(), (Bytes{1, 2, 3, 4, 5}));
}

TEST(Pack, gives_back_numbers_of_any_size_and_short_texts) {
  Packer out;
  out.varint(0).varint(127).varint(128).varint(~std::uint64_t{0});
  EXPECT_EQ(out.bytes().size(), 1u + 1 + 2 + 10);
  out.zigzag(0).zigzag(-64).zigzag(64).zigzag(INT64_MIN).zigzag(INT64_MAX).text<std::uint8_t>("robot");
  Unpacker in(out.bytes());
  for (const std::uint64_t value :
       {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128}, ~std::uint64_t{0}})
    EXPECT_EQ(in.varint(), value);
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{-64}, std::int64_t{64}, INT64_MIN, INT64_MAX})
    EXPECT_EQ(in.zigzag(), value);
  EXPECT_EQ(in.text<std::uint8_t>(5), "robot");
  EXPECT_TRUE(in.done());
  EXPECT_EQ(Packer{}.varint(300).zigzag(-2).text<std::uint8_t>("r").bytes(), (Bytes{0xac, 0x02, 3, 1, 'r'}));
}

TEST(Unpack, fails_for_good_at_the_first_thing_that_does_not_fit) {
  const Bytes three{1, 0, 0};
  Unpacker short_number(three);
  EXPECT_EQ(short_number.get<std::uint32_t>(), 0u);
  EXPECT_EQ(short_number.get<std::uint8_t>(), 0)
      << "there would be a byte, but it is not where it is thought";
  EXPECT_FALSE(short_number.good());
  const Bytes two{2};
  Unpacker no_flag(two);
  (void)no_flag.flag();
  EXPECT_FALSE(no_flag.good());
  const Bytes text = Packer{}.text("too long").bytes();
  Unpacker long_text(text);
  (void)long_text.text(7);
  EXPECT_FALSE(long_text.good());
  const Bytes endless(11, 0x80);
  Unpacker too_wide(endless);
  EXPECT_EQ(too_wide.varint(), 0u);
  EXPECT_FALSE(too_wide.good());
  const Bytes many = Packer{}.put(std::uint16_t{9}).bytes();
  Unpacker too_many(many);
  EXPECT_EQ(too_many.count(8), 0u);
  EXPECT_FALSE(too_many.good());
}

TEST(Unpack, takes_any_bytes) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Bytes junk(random.below(60));
    for (auto& byte : junk) byte = static_cast<std::uint8_t>(random.next());
    Unpacker in(junk);
    while (in.good()) {
      switch (random.below(5)) {
        case 0:
          (void)in.text(20);
          break;
        case 1:
          (void)in.count(10);
          break;
        case 2:
          (void)in.flag();
          break;
        case 3:
          (void)in.zigzag();
          break;
        default:
          (void)in.array<16>();
      }
    }
    EXPECT_FALSE(in.done());
  }
}

}  // namespace
}  // namespace adit::store

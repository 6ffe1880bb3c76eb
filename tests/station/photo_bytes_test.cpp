// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/photo_bytes.hpp"

#include <gtest/gtest.h>

#include "basestation/model/json.hpp"
#include "core/findings/photo.hpp"
#include "core/time/random.hpp"

namespace adit::station {
namespace {

TEST(PhotoBytes, ComeBackAsTheyWere) {
  Random random(3);
  for (std::size_t size = 0; size < 200; ++size) {
    store::Bytes bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    const auto read = photo_of({.json = line_of(photo_json(bytes))});
    ASSERT_TRUE(read.ok()) << read.error().text;
    EXPECT_EQ(*read, bytes);
  }
  // RFC 4648, section 10.
  const std::string foobar = "foobar";
  const auto encoded = [&](std::size_t size) {
    return base64_of({reinterpret_cast<const std::uint8_t*>(foobar.data()), size});
  };
  EXPECT_EQ(encoded(4), "Zm9vYg==");
  EXPECT_EQ(encoded(5), "Zm9vYmE=");
  EXPECT_EQ(encoded(6), "Zm9vYmFy");
}

TEST(PhotoBytes, WhatIsNoneIsRefused) {
  for (const char* bad : {"A", "AA", "AAA", "A===", "====", "AA=A", "AA A", "AAA\n", "AA-_", "AAAA=AAA"})
    EXPECT_EQ(bytes_of_base64(bad).reason(), Reason::malformed) << bad;
  for (const char* bad : {"no JSON", "[]", R"({"jpeg": 5})", R"({"jpeg": "A"})"})
    EXPECT_EQ(photo_of({.json = bad}).reason(), Reason::malformed) << bad;
  EXPECT_EQ(photo_of({.exit_code = kExitRefused, .error = "it is not here"}).reason(), Reason::no_answer);
  const std::string large(findings::Photo::kMaxInput / 3 * 4 + 100, 'A');
  EXPECT_EQ(photo_of({.json = R"({"jpeg": ")" + large + "\"}"}).reason(), Reason::out_of_range);
}

TEST(PhotoBytes, AnIdHasSixteenHexadecimalDigits) {
  EXPECT_EQ(photo_id_from("00000000000000ff"), 255U);
  EXPECT_EQ(photo_id_from("ffffffffffffffff"), ~std::uint64_t{0});
  for (const char* bad :
       {"", "ff", "00000000000000fg", "0x000000000000ff", "-0000000000000ff", "00000000000000ff0"})
    EXPECT_FALSE(photo_id_from(bad)) << bad;
}

}  // namespace
}  // namespace adit::station

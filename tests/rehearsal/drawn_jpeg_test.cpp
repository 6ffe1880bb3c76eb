// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/drawn_jpeg.hpp"

#include <gtest/gtest.h>

#include "core/findings/photo.hpp"

namespace adit::sim {
namespace {

TEST(DrawnJpeg, HasTheSizeThatIsWantedAndIsAPhoto) {
  for (const std::size_t kilobytes : {5U, 20U, 40U, 256U}) {
    const store::Bytes jpeg = drawn_jpeg(kilobytes * 1024, 7);
    EXPECT_NEAR(static_cast<double>(jpeg.size()), 1024.0 * kilobytes, 102.4 * kilobytes);
    EXPECT_TRUE(findings::make_photo(jpeg).ok()) << kilobytes;
  }
  EXPECT_TRUE(findings::make_photo(drawn_jpeg(0, 7)).ok()) << "the smallest";
}

TEST(DrawnJpeg, IsDrawnByItsSeedAlone) {
  EXPECT_EQ(drawn_jpeg(20'000, 1), drawn_jpeg(20'000, 1));
  EXPECT_NE(drawn_jpeg(20'000, 1), drawn_jpeg(20'000, 2));
}

}  // namespace
}  // namespace adit::sim

// SPDX-License-Identifier: Apache-2.0
#include "nav/tracking/upright_range_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace adit::nav::test {
namespace {

/// A ring of returns at `range`, one for each degree.
std::unique_ptr<UprightRangeImage> ring(float range, float near = 0.0f, int near_degree = -1) {
  auto out = std::make_unique<UprightRangeImage>();
  out->clear();
  for (int degree = 0; degree < 360; ++degree) {
    const float r = degree == near_degree ? near : range, a = static_cast<float>(degree * M_PI / 180);
    out->add(Ray::to(r * std::cos(a), r * std::sin(a), 0.0f));
  }
  out->spread();
  return out;
}

bool past(const UprightRangeImage& p, float range, float degree, float dz = 0.0f) {
  const float a = degree * static_cast<float>(M_PI) / 180;
  return p.saw_past(Ray::to(range * std::cos(a), range * std::sin(a), dz), 0.15f);
}

TEST(UprightRangeImage, SawPastNearerPlacesInEveryDirection) {
  const auto p = ring(5.0f);
  for (int degree = -180; degree <= 540; degree += 7) {
    EXPECT_TRUE(past(*p, 3.0f, static_cast<float>(degree))) << degree;
    EXPECT_FALSE(past(*p, 4.95f, static_cast<float>(degree))) << degree << ": that is the wall itself";
    EXPECT_FALSE(past(*p, 6.0f, static_cast<float>(degree))) << degree;
  }
}

TEST(UprightRangeImage, ARayThatEndedBesideThePlaceCounts) {
  for (const int degree : {0, 45, 179, 270, 359}) {
    const auto p = ring(5.0f, 2.0f, degree);
    for (const float beside : {-1.0f, 0.0f, 1.0f})
      EXPECT_FALSE(past(*p, 3.0f, static_cast<float>(degree) + beside)) << degree << " " << beside;
    EXPECT_TRUE(past(*p, 3.0f, static_cast<float>(degree) + 6.0f)) << degree;
    EXPECT_TRUE(past(*p, 3.0f, static_cast<float>(degree) - 6.0f)) << degree;
    EXPECT_TRUE(past(*p, 1.5f, static_cast<float>(degree))) << "before it the way was free";
  }
}

TEST(UprightRangeImage, DirectionsWithoutAReturnAreUnknown) {
  UprightRangeImage nothing;
  nothing.spread();
  EXPECT_FALSE(past(nothing, 1.0f, 0.0f));
  const auto level = ring(5.0f);
  EXPECT_FALSE(past(*level, 2.0f, 30.0f, 1.0f)) << "above the ring";
  EXPECT_FALSE(past(*level, 2.0f, 30.0f, 1e6f));
}

TEST(UprightRangeImage, TheRingsAboveAndBelowCountToo) {
  // A ring that passes over a crate and one that ends at its front.
  UprightRangeImage p;
  for (int degree = 0; degree < 360; ++degree) {
    const float a = static_cast<float>(degree * M_PI / 180), c = std::cos(a), s = std::sin(a);
    p.add(Ray::to(8 * c, 8 * s, 0.5f));
    p.add(Ray::to(3 * c, 3 * s, -0.06f));
  }
  p.spread();
  EXPECT_FALSE(p.saw_past(Ray::to(4.0f, 0.0f, 0.0f), 0.15f));
  EXPECT_TRUE(p.saw_past(Ray::to(4.0f, 0.0f, 0.28f), 0.15f)) << "far above the lower ring";
}

}  // namespace
}  // namespace adit::nav::test

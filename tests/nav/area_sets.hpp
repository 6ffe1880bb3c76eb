// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <vector>

#include "nav/areas/area_set.hpp"

namespace adit::nav::test {

/// The set of these areas, which must be valid.
inline AreaSet set_of(const std::vector<Area>& areas) {
  AreaSet set;
  for (const Area& each : areas) {
    const auto valid = checked(each);
    EXPECT_TRUE(valid && set.add(*valid)) << each.name;
  }
  return set;
}

}  // namespace adit::nav::test

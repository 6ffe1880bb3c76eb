// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "nav/local_map/local_map_builder.hpp"

namespace adit::nav::test {

/// What has a cost in the local map that is made of `terrain`.
inline std::vector<LocalPlace> places(const TerrainMap& terrain) {
  const auto map = LocalMapBuilder().make(terrain, {});
  return {map->places().begin(), map->places().end()};
}

}  // namespace adit::nav::test

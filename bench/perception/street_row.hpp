// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::bench {

/// Runs the odometry over a folder of real clouds without other sensors (one each 0.1 s) and prints how far
/// it and each peer's trajectory are from each other over ten clouds, and the time per cloud.
///
/// @param peers  NAME=FILE.tum, one pose a cloud.
Result<void> print_street(const std::string& clouds, const std::vector<std::string>& peers);

}  // namespace adit::bench

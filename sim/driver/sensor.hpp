// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::sim {

/// What a simulated driver gives.
enum class Sensor { lidar, odometry };

}  // namespace adit::sim

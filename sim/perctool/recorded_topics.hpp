// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::sim::perctool {

/// True poses of base_link in an MCAP file of `perctool record`: nav_msgs/Odometry in the frame `world`.
inline constexpr const char* kTruthTopic = "truth";
/// Metadata of such a file: scenario, robot, seed, and the `sensors:` part of the platform's file.
inline constexpr const char* kAboutRecording = "perctool";

}  // namespace adit::sim::perctool

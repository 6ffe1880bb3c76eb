// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "bench/map_link/rule.hpp"

namespace adit::bench {

struct MissionPlan {
  wire::LinkProfile link{};
  std::uint64_t seed{1};
  std::optional<Duration> cut_from{};  ///< The link is cut from then until the end of the recordings.
  Duration limit{240s};                ///< Longest time after the recordings until all is known.
};

/// What a mission with one rule gave. Times of a cut are since its end.
struct MissionResult {
  Air::Count robots{}, station{};  ///< Sent until all was known.
  double share_at_end{};           ///< Of seen cells, known when the robots stopped.
  std::vector<Duration> ages{};    ///< Of cells, see Watch.
  std::vector<Duration> waits{};
  Account account{};
  bool settled{};                  ///< Nothing was left to send before the limit.
  std::size_t different_voxels{};  ///< See Rule.
  std::size_t different_blocks{};  ///< At the end, that the station shows otherwise.
  Duration after{};                ///< Time after the recordings until nothing was left to send.
  std::optional<Duration> coarse_95{}, coarse_99{}, coarse_all{}, all_equal{};
};

/// Sends recorded maps by a rule.
MissionResult run_mission(const std::vector<MapRecording>& robots, const MissionPlan& plan,
                          const MakeRule& make);

/// The map of a recording at its end, or until a time, merged.
std::vector<perception::CoarseBlock> final_map(const MapRecording& recording);
/// Ground that the robot saw first after `from`, m2.
double area_seen_since(const MapRecording& recording, Duration from);

}  // namespace adit::bench

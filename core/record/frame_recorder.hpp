// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>

#include "core/record/channels.hpp"
#include "core/wire/memory/simulated_network.hpp"

namespace adit::record {

/// Parameters of FrameRecorder.
struct FrameRecorderParams {
  std::string file{};
  std::uint32_t radio_domain{77};  ///< All other domains are inner networks.
  Text about{};                    ///< Metadata of the file: scenario, seed.
  /// Size above which a sample (a scan) is large, bytes. Large samples are thinned.
  std::size_t large{16 << 10};
  Duration large_period{1s};  ///< One large sample of each channel is recorded in this time; 0: all.
};

/// Records a rehearsal's radio and inner networks in one MCAP file. Sent samples are in the channel
/// "MACHINE/TOPIC"; samples that reached another machine in "MACHINE/TOPIC>RECEIVER", lost ones in
/// "MACHINE/TOPIC>RECEIVER/lost"; for inner networks only sent samples are recorded. Times are those of the
/// run, from 0. Recording does not affect the run.
class FrameRecorder {
 public:
  /// Opens the file. Error cannot_write.
  static Result<std::unique_ptr<FrameRecorder>> open(FrameRecorderParams params);
  /// Records one event; the simulated network's tap calls it.
  void see(const wire::SampleEvent& frame);
  /// Completes the file. Error cannot_write: some data is missing.
  Result<void> close();

 private:
  struct Known {
    ChannelInfo info{};
    ChannelId id{};
    Duration last_large{Duration::min()};
  };
  FrameRecorder(std::unique_ptr<Output> output, FrameRecorderParams params);
  Known& channel(const wire::SampleEvent& frame);

  FrameRecorderParams params_;
  std::unique_ptr<Output> output_;
  McapWriter writer_;
  Channels channels_{writer_};
  std::map<std::string, Known, std::less<>> known_{};
  std::string key_{};
  Result<void> state_{};
};

}  // namespace adit::record

#pragma once
#include <map>
#include <memory>
#include <string>

#include "core/record/channels.hpp"
#include "core/wire/memory/simulated_network.hpp"

namespace adit::record {

struct FrameRecorderParams {
  std::string file{};
  std::uint32_t radio_domain{77};  ///< all others are inner networks
  Text about{};                    ///< metadata of the file: scenario, seed
  std::size_t large{16 << 10};     ///< bytes; of longer samples (scans) only some are kept:
  Duration large_period{1s};       ///< one of each channel in this time; 0: all
};

/// A rehearsal's radio and inner networks in one MCAP file. What a machine sent stands under "MACHINE/TOPIC";
/// what reached another under "MACHINE/TOPIC>RECEIVER", what was lost on the way under
/// "MACHINE/TOPIC>RECEIVER/lost"; of inner networks what was sent alone. Times are the run's, from 0. Nothing
/// of the run depends on it.
class FrameRecorder {
 public:
  /// Error cannot_write.
  static Result<std::unique_ptr<FrameRecorder>> open(FrameRecorderParams params);
  /// To be called by the simulated network's tap.
  void see(const wire::SampleEvent& frame);
  /// Ends the file. Error cannot_write: from then on, or from earlier on, something is missing.
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

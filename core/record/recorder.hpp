#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/record/record_sink.hpp"
#include "core/record/ring.hpp"
#include "core/time/time.hpp"

namespace adit::record {

struct RecorderParams {
  RingParams ring{};
  std::size_t queue_bytes{4 << 20};  ///< messages waiting to be written; more are dropped and counted
  Duration flush{1s};                ///< what is older than this survives a kill of the process
  std::size_t large{16 << 10};       ///< bytes; of longer messages (scans, pictures) only some are kept:
  Duration large_period{5s};         ///< one of each channel in this time; 0: all
  bool compress{true};               ///< by Zstandard, where the build has it
  std::string library{"adit"};       ///< who wrote it, and its version
  Text about{};                      ///< metadata of every file
  std::function<std::uint64_t()> clock{};   ///< ns since 1970; the system's when empty
  std::function<std::uint64_t()> steady{};  ///< ns, never steps: for pauses; the system's when empty
  std::function<void(const std::string& text)> on_error{};  ///< once per trouble, on the writing thread
};

struct RecorderCounters {
  std::uint64_t recorded{}, dropped{};  ///< messages; dropped: queue or disk full
  std::uint64_t thinned{};              ///< large ones left out on purpose
  std::uint64_t files{}, failed_files{};
};

/// Keeps the last minutes in a ring of MCAP files. Written by a thread of its own, so that a slow disk holds
/// nobody up; a full one is told once, tried again every 5 s, and costs recordings only. Its destructor
/// writes what waits.
class Recorder final : public RecordSink {
 public:
  explicit Recorder(RecorderParams params);
  ~Recorder() override;
  /// At most 4096 channels at a time; those beyond share one.
  ChannelId channel(const ChannelInfo& info) override;
  void release(ChannelId channel) override;
  void record(ChannelId channel, ByteSpan cdr) override;
  RecorderCounters counters() const;

 private:
  struct Known {
    ChannelInfo info{};
    std::uint64_t last_large{};
    bool had_large{};
    int users{};
  };
  struct File;

  void run();
  const ChannelInfo& info(ChannelId channel);
  bool write(const std::vector<std::uint8_t>& batch);
  bool open();
  bool lost(const Error& error);

  const RecorderParams params_;
  Ring ring_;
  std::unique_ptr<File> file_{};          // on the writing thread
  std::uint64_t retry_at_{}, written_{};  // the same
  bool troubled_{};                       // the same

  mutable std::mutex mutex_{};
  std::condition_variable wake_{};
  std::vector<std::uint8_t> queue_{};
  std::map<ChannelInfo, ChannelId> ids_{};
  std::map<ChannelId, std::shared_ptr<Known>> known_{};
  std::map<ChannelId, std::shared_ptr<Known>> released_{};  ///< until what waits for them is written
  ChannelId next_id_{};
  RecorderCounters counters_{};
  bool ending_{};
  std::thread thread_{};
};

}  // namespace adit::record

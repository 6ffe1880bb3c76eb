// SPDX-License-Identifier: Apache-2.0
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

/// Parameters of Recorder.
struct RecorderParams {
  RingParams ring{};
  std::size_t queue_bytes{4 << 20};  ///< Size of the queue, bytes; further messages are dropped and counted.
  Duration flush{1s};                ///< Messages older than this survive a kill of the process.
  /// Size above which a message (a scan, an image) is large, bytes. Large messages are thinned.
  std::size_t large{16 << 10};
  Duration large_period{5s};    ///< One large message of each channel is recorded in this time; 0: all.
  bool compress{true};          ///< Compress with Zstandard, if it is built in.
  std::string library{"adit"};  ///< Name and version of the writing program.
  Text about{};                 ///< Metadata of every file.
  std::function<std::uint64_t()> clock{};   ///< Nanoseconds since 1970; empty: the system's clock.
  std::function<std::uint64_t()> steady{};  ///< Steady clock for pauses, ns; empty: the system's.
  /// Called once per problem, on the writing thread.
  std::function<void(const std::string& text)> on_error{};
};

/// Counters of a recorder since its start.
struct RecorderCounters {
  std::uint64_t recorded{}, dropped{};  ///< Numbers of messages; dropped: the queue or the disk was full.
  std::uint64_t thinned{};              ///< Large messages left out on purpose.
  std::uint64_t files{}, failed_files{};
};

/// Records the last minutes in a ring of MCAP files. A separate thread writes them, so that a slow disk
/// delays no strand. A full disk is reported once, retried every 5 s, and affects only the recording. The
/// destructor writes the queued messages.
class Recorder final : public RecordSink {
 public:
  explicit Recorder(RecorderParams params);
  ~Recorder() override;
  /// Adds a channel. At most 4096 exist at a time; those beyond share one.
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
  std::unique_ptr<File> file_{};          // Used on the writing thread.
  std::uint64_t retry_at_{}, written_{};  // Used on the writing thread.
  bool troubled_{};                       // Used on the writing thread.

  mutable std::mutex mutex_{};
  std::condition_variable wake_{};
  std::vector<std::uint8_t> queue_{};
  std::map<ChannelInfo, ChannelId> ids_{};
  std::map<ChannelId, std::shared_ptr<Known>> known_{};
  /// Released channels whose queued messages are not written yet.
  std::map<ChannelId, std::shared_ptr<Known>> released_{};
  ChannelId next_id_{};
  RecorderCounters counters_{};
  bool ending_{};
  std::thread thread_{};
};

}  // namespace adit::record

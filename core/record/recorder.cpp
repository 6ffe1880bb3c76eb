// SPDX-License-Identifier: Apache-2.0
#include "core/record/recorder.hpp"

#include <pthread.h>

#include <chrono>

#include "core/record/channels.hpp"

namespace adit::record {
namespace {

constexpr std::size_t kMaxChannels = 4096;
constexpr std::uint64_t kRetryAfter = 5'000'000'000;  // In ns.
// Size of an entry's header in the queue: channel, time, size.
constexpr std::size_t kEntryHead = 4 + 8 + 4;

std::uint64_t system_time() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

std::uint64_t steady_time() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::steady_clock::now().time_since_epoch())
                                        .count());
}

RecorderParams checked(RecorderParams params) {
  if (!params.clock) params.clock = system_time;
  if (!params.steady) params.steady = steady_time;
  if (!params.on_error) params.on_error = [](const std::string&) {};
  return params;
}

}  // namespace

/// One segment during writing.
struct Recorder::File {
  File(std::unique_ptr<Output> opened, const RecorderParams& params)
      : output(std::move(opened)), writer(*output, {256 << 10, params.compress, params.library}) {}
  std::unique_ptr<Output> output;
  McapWriter writer;
  Channels channels{writer};
};

Recorder::Recorder(RecorderParams params) : params_(checked(std::move(params))), ring_(params_.ring) {
  queue_.reserve(params_.queue_bytes);
  thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

ChannelId Recorder::channel(const ChannelInfo& wanted) {
  const std::lock_guard lock(mutex_);
  const bool others = known_.size() >= kMaxChannels && !ids_.contains(wanted);
  const ChannelInfo info =
      others ? ChannelInfo{"others", "", {{kMalformedKey, "too many channels"}}} : wanted;
  const auto [it, fresh] = ids_.try_emplace(info, next_id_);
  if (fresh) known_[next_id_++] = std::make_shared<Known>(Known{info, 0, false, 0});
  ++known_.at(it->second)->users;
  return it->second;
}

void Recorder::release(ChannelId channel) {
  const std::lock_guard lock(mutex_);
  const auto it = known_.find(channel);
  if (it == known_.end() || --it->second->users > 0) return;
  auto known = known_.extract(it);
  ids_.erase(known.mapped()->info);
  released_.insert(std::move(known));
}

void Recorder::record(ChannelId channel, ByteSpan cdr) {
  const std::uint64_t now = params_.clock();
  const std::lock_guard lock(mutex_);
  const auto found = known_.find(channel);
  if (found == known_.end()) return;
  Known& known = *found->second;
  if (cdr.size() > params_.large && params_.large_period > 0ns) {
    const auto period = static_cast<std::uint64_t>(params_.large_period.count());
    if (known.had_large && now - known.last_large < period) {
      ++counters_.thinned;
      return;
    }
    known.had_large = true;
    known.last_large = now;
  }
  if (queue_.size() + kEntryHead + cdr.size() > params_.queue_bytes) {
    ++counters_.dropped;
    return;
  }
  McapPacker pack(queue_);
  pack.put(channel);
  pack.put(now);
  pack.put(static_cast<std::uint32_t>(cdr.size()));
  pack.bytes(cdr);
}

RecorderCounters Recorder::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

void Recorder::run() {
  ::pthread_setname_np(::pthread_self(), "recorder");
  std::vector<std::uint8_t> batch;
  std::map<ChannelId, std::shared_ptr<Known>> last_of;  // Released before this batch was taken.
  batch.reserve(params_.queue_bytes);
  for (bool ending = false; !ending;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, params_.flush, [this] { return ending_; });
      ending = ending_;
      std::swap(batch, queue_);
      last_of = released_;
    }
    written_ = 0;
    const bool all_written = batch.empty() || write(batch);
    std::uint64_t all = 0;
    for (McapUnpacker entries(batch); entries.left() > 0; ++all) {
      entries.take(kEntryHead - 4);
      entries.take(entries.get<std::uint32_t>());
    }
    batch.clear();
    const std::lock_guard lock(mutex_);
    for (const auto& [id, known] : last_of) released_.erase(id);
    counters_.recorded += all_written ? all : written_;
    counters_.dropped += all_written ? 0 : all - written_;
  }
  // An error costs only the summary: the file is readable without it.
  if (file_) (void)file_->writer.close();
}

/// Returns the info of a channel. It never changes, and lives until the batch is written.
const ChannelInfo& Recorder::info(ChannelId channel) {
  const std::lock_guard lock(mutex_);
  const auto known = known_.find(channel);
  return known != known_.end() ? known->second->info : released_.at(channel)->info;
}

/// Writes a batch. Returns false when the disk did not take all of it; the first `written_` messages are then
/// in the file.
bool Recorder::write(const std::vector<std::uint8_t>& batch) {
  McapUnpacker entries(batch);
  while (entries.left() > 0) {
    if (!file_ && !open()) return false;
    const auto id = entries.get<ChannelId>();
    const auto time = entries.get<std::uint64_t>();
    const ByteSpan cdr = entries.take(entries.get<std::uint32_t>());
    const auto done = file_->writer.write(file_->channels.get(id, info(id)), time, cdr);
    if (!done) return lost(done.error());
    ++written_;
    if (file_->writer.size() < ring_.params().segment_bytes) continue;
    if (const auto closed = file_->writer.close(); !closed) return lost(closed.error());
    file_.reset();
  }
  if (!file_) return true;
  if (const auto flushed = file_->writer.flush(); !flushed) return lost(flushed.error());
  return true;
}

bool Recorder::open() {
  if (troubled_ && params_.steady() < retry_at_) return false;
  auto output = ring_.next();
  if (!output) return lost(output.error());
  file_ = std::make_unique<File>(std::move(*output), params_);
  if (const auto added = file_->writer.add_metadata("adit", params_.about); !added)
    return lost(added.error());
  troubled_ = false;
  const std::lock_guard lock(mutex_);
  ++counters_.files;
  return true;
}

bool Recorder::lost(const Error& error) {
  if (!troubled_) params_.on_error("recording is interrupted: " + error.text);
  troubled_ = true;
  retry_at_ = params_.steady() + kRetryAfter;
  file_.reset();
  const std::lock_guard lock(mutex_);
  ++counters_.failed_files;
  return false;
}

}  // namespace adit::record

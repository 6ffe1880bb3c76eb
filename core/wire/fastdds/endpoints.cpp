// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/endpoints.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <algorithm>
#include <chrono>

#include "core/wire/cdr_key.hpp"
#include "core/wire/cost.hpp"
#include "core/wire/fastdds/endpoint_qos.hpp"
#include "core/wire/fastdds/filtering_transport.hpp"
#include "core/wire/fastdds/link_shaper.hpp"
#include "core/wire/qos.hpp"

namespace adit::wire {
namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;
using SteadyClock = std::chrono::steady_clock;

std::vector<TopicCount> SharedCounts::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<TopicCount> result;
  for (const auto& [key, count] : counts_) result.push_back(count);
  return result;
}

Result<std::unique_ptr<RawWriter>> FastDdsWriter::make(dds::Publisher& publisher, dds::Topic& dds_topic,
                                                       const TopicInfo& topic,
                                                       std::shared_ptr<SharedCounts> counts,
                                                       std::shared_ptr<TransportContext> context) {
  std::unique_ptr<FastDdsWriter> writer(new FastDdsWriter(publisher, topic, std::move(counts)));
  writer->writer_ = publisher.create_datawriter(
      &dds_topic, dds_writer_qos(topic, context->link && context->link->profile() != nullptr), writer.get(),
      dds::StatusMask::publication_matched());
  if (writer->writer_ == nullptr) {
    return Error{Reason::wire_failed,
                 std::string(topic.name) + ": Fast DDS refused the writer; its log says why"};
  }
  const Qos qos = writer_qos(topic);
  const auto& id = writer->writer_->guid().entityId.value;
  writer->entity_ = static_cast<std::uint32_t>(id[0]) << 24 | id[1] << 16 | id[2] << 8 | id[3];
  // Samples between a reliable writer and a reliable reader of ours go to that reader, too. It must
  // acknowledge them; otherwise the writer keeps requesting acknowledgements from all other readers, too.
  if (!qos.reliable || !reader_qos(topic).reliable) context->to_others.add(writer->entity_);
  if (context->link)
    context->link->add_writer(writer->entity_, qos.priority, qos.newest_wins && !qos.reliable, topic.keyed);
  writer->context_ = std::move(context);
  return std::unique_ptr<RawWriter>(std::move(writer));
}

FastDdsWriter::FastDdsWriter(dds::Publisher& publisher, const TopicInfo& topic,
                             std::shared_ptr<SharedCounts> counts)
    : publisher_(publisher),
      topic_(topic.name),
      keyed_(topic.keyed),
      max_bytes_(topic.max_bytes),
      counts_(std::move(counts)) {}

FastDdsWriter::~FastDdsWriter() {
  if (writer_ != nullptr) publisher_.delete_datawriter(writer_);
  if (!context_) return;
  context_->to_others.remove(entity_);
  if (context_->link) context_->link->remove_writer(entity_);
}

Result<void> FastDdsWriter::failed(Reason reason, const std::string& why) {
  counts_->change(topic_, {}, [](TopicCount& c) { ++c.failed_writes; });
  return Error{reason, topic_ + ": " + why};
}

Result<void> FastDdsWriter::write(std::span<const std::uint8_t> cdr) {
  if (cdr.size() > max_bytes_) {
    return failed(Reason::out_of_range, "sample of " + std::to_string(cdr.size()) + " bytes, at most " +
                                            std::to_string(max_bytes_) + " are allowed");
  }
  if (cdr.size() < 4 || (keyed_ && !first_string(cdr)))
    return failed(Reason::malformed, "the sample has no key");
  SerializedSample bytes;
  bytes.out = cdr;
  ReturnCode_t code;
  try {
    code = writer_->write(&bytes, dds::HANDLE_NIL);
  } catch (const std::exception& e) {
    return failed(Reason::wire_failed, e.what());
  }
  if (code != ReturnCode_t::RETCODE_OK) {
    return failed(Reason::queue_full,
                  "Fast DDS did not take the sample (return code " + std::to_string(code()) + ")");
  }
  const std::uint64_t on_the_network =
      static_cast<std::uint64_t>(matched_.load()) * WireCost::sample(cdr.size());
  counts_->change(topic_, {}, [&](TopicCount& c) {
    ++c.samples_out;
    c.bytes_out += on_the_network;
  });
  return {};
}

void FastDdsWriter::on_publication_matched(dds::DataWriter* writer,
                                           const dds::PublicationMatchedStatus& status) {
  const rtps::GUID_t reader = rtps::iHandle2GUID(status.last_subscription_handle);
  if (reader.guidPrefix == writer->guid().guidPrefix) own_ += status.current_count_change;
  matched_.store(status.current_count - own_);
}

Result<std::unique_ptr<RawReader>> FastDdsReader::make(dds::Subscriber& subscriber, dds::Topic& dds_topic,
                                                       const TopicInfo& topic,
                                                       std::shared_ptr<SharedCounts> counts, Executor& strand,
                                                       RawHandler handler) {
  std::unique_ptr<FastDdsReader> reader(new FastDdsReader(subscriber));
  reader->target_ = std::make_shared<Target>(topic, std::move(counts), strand, std::move(handler));
  reader->reader_ =
      subscriber.create_datareader(&dds_topic, dds_reader_qos(topic), reader.get(),
                                   dds::StatusMask::data_available() << dds::StatusMask::sample_lost());
  if (reader->reader_ == nullptr) {
    return Error{Reason::wire_failed,
                 std::string(topic.name) + ": Fast DDS refused the reader; its log says why"};
  }
  return std::unique_ptr<RawReader>(std::move(reader));
}

FastDdsReader::~FastDdsReader() {
  if (target_) target_->close();
  if (reader_ != nullptr) subscriber_.delete_datareader(reader_);  // Blocks until our listener has returned.
}

FastDdsReader::Target::Target(const TopicInfo& info, std::shared_ptr<SharedCounts> shared, Executor& strand,
                              RawHandler handler)
    : topic(info.name),
      keyed(info.keyed),
      max_bytes(info.max_bytes),
      counts(std::move(shared)),
      strand_(strand),
      in_place_(handled_in_place(info) ? dynamic_cast<InPlace*>(&strand) : nullptr),
      handler_(std::move(handler)),
      mailbox_(mailbox_depth(info), info.max_bytes) {}

FastDdsReader::Buffer FastDdsReader::Target::buffer() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return {};
  Buffer buffer = std::move(spare_.back());
  spare_.pop_back();
  return buffer;
}

void FastDdsReader::Target::recycle(Buffer buffer) {
  constexpr std::size_t most = 2;  // One buffer is being handled while another is received into.
  if (spare_.size() < most) spare_.push_back(std::move(buffer));
}

void FastDdsReader::Target::put(Box::Entry entry) {
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  mailbox_.put(std::move(entry), [this](Box::Entry old) {
    counts->change(topic, old.sender, [](TopicCount& c) { ++c.overwritten; });
    recycle(std::move(old.payload));
  });
}

void FastDdsReader::Target::notify() {
  {
    const std::lock_guard lock(mutex_);
    if (posted_ || closed_ || mailbox_.empty()) return;
    posted_ = true;
  }
  if (in_place_ != nullptr && in_place_->try_run([this] { handle(); })) return;
  post();
}

void FastDdsReader::Target::post() {
  // Uses the control queue: a reader has one such task at a time, so it needs no bound.
  if (strand_.post_control([self = shared_from_this()] { self->handle(); })) return;
  const std::lock_guard lock(mutex_);
  posted_ = false;
}

bool FastDdsReader::Target::handle_one() {
  const std::lock_guard handling(handling_);
  Box::Entry entry;
  {
    const std::lock_guard lock(mutex_);
    if (closed_ || mailbox_.empty()) {
      posted_ = false;
      return false;
    }
    entry = mailbox_.take();
  }
  if (!handler_(entry.payload, SampleInfo{entry.sender, entry.received}))
    counts->change(topic, entry.sender, [](TopicCount& c) { ++c.malformed; });
  const std::lock_guard lock(mutex_);
  recycle(std::move(entry.payload));
  return true;
}

void FastDdsReader::Target::handle() {
  try {
    for (int i = 0; i < kBurstSamples; ++i) {
      if (!handle_one()) return;
    }
  } catch (...) {
    post();  // The samples after it are still handled.
    throw;
  }
  post();
}

void FastDdsReader::Target::close() {
  const std::lock_guard handling(handling_);
  const std::lock_guard lock(mutex_);
  closed_ = true;
  mailbox_.clear();
}

void FastDdsReader::on_data_available(dds::DataReader* reader) {
  SerializedSample bytes;
  bytes.max_bytes = target_->max_bytes;
  bytes.in = target_->buffer();
  for (;;) {
    dds::SampleInfo info;
    try {
      if (reader->take_next_sample(&bytes, &info) != ReturnCode_t::RETCODE_OK) break;
    } catch (const std::exception&) {
      target_->counts->change(target_->topic, {}, [](TopicCount& c) { ++c.malformed; });
      break;
    }
    if (!info.valid_data) continue;
    const Time received(std::chrono::duration_cast<Duration>(SteadyClock::now().time_since_epoch()));
    const rtps::GUID_t writer = rtps::iHandle2GUID(info.publication_handle);
    if (writer.guidPrefix == reader->guid().guidPrefix) continue;  // This participant's own writer.
    ParticipantId sender{};
    std::copy(std::begin(writer.guidPrefix.value), std::end(writer.guidPrefix.value), sender.begin());
    target_->counts->change(target_->topic, sender, [&](TopicCount& c) {
      ++c.samples_in;
      c.bytes_in += WireCost::sample(bytes.in.size());
      if (bytes.too_long) ++c.malformed;
    });
    if (bytes.too_long) continue;
    const auto key = target_->keyed ? first_string(bytes.in) : std::nullopt;
    const std::size_t size = bytes.in.size();
    target_->put({sender, key ? key_number(*key) : 0, received, size, std::move(bytes.in)});
    bytes.in = target_->buffer();
  }
  target_->notify();
}

void FastDdsReader::on_sample_lost(dds::DataReader*, const dds::SampleLostStatus& status) {
  // Fast DDS does not say here which writer it was.
  target_->counts->change(target_->topic, {}, [&](TopicCount& c) {
    c.lost += static_cast<std::uint64_t>(std::max(0, status.total_count_change));
  });
}

}  // namespace adit::wire

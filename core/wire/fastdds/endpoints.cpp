#include "core/wire/fastdds/endpoints.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <algorithm>

#include "core/wire/cdr_key.hpp"
#include "core/wire/cost.hpp"
#include "core/wire/fastdds/endpoint_qos.hpp"
#include "core/wire/fastdds/live_link.hpp"
#include "core/wire/qos.hpp"

namespace adit::wire {
namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;

std::vector<TopicCount> SharedCounts::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<TopicCount> result;
  for (const auto& [key, count] : counts_) result.push_back(count);
  return result;
}

Result<std::unique_ptr<RawWriter>> FastDdsWriter::make(dds::Publisher& publisher, dds::Topic& dds_topic,
                                                       const TopicInfo& topic,
                                                       std::shared_ptr<SharedCounts> counts,
                                                       std::shared_ptr<LiveLink> link) {
  std::unique_ptr<FastDdsWriter> writer(new FastDdsWriter(publisher, topic, std::move(counts)));
  writer->writer_ =
      publisher.create_datawriter(&dds_topic, dds_writer_qos(topic, link && link->profile() != nullptr),
                                  writer.get(), dds::StatusMask::publication_matched());
  if (writer->writer_ == nullptr) {
    return Error{Reason::wire_failed,
                 std::string(topic.name) + ": Fast DDS refused the writer; its log says why"};
  }
  if (link) {
    const Qos qos = writer_qos(topic);
    const auto& id = writer->writer_->guid().entityId.value;
    writer->entity_ = static_cast<std::uint32_t>(id[0]) << 24 | id[1] << 16 | id[2] << 8 | id[3];
    link->add_writer(writer->entity_, qos.priority, qos.newest_wins && !qos.reliable, topic.keyed);
    writer->link_ = std::move(link);
  }
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
  if (link_) link_->remove_writer(entity_);
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
  Bytes bytes;
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

void FastDdsWriter::on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& status) {
  matched_.store(status.current_count);
}

Result<std::unique_ptr<RawReader>> FastDdsReader::make(dds::Subscriber& subscriber, dds::Topic& dds_topic,
                                                       const TopicInfo& topic,
                                                       std::shared_ptr<SharedCounts> counts, Executor& strand,
                                                       RawHandler handler) {
  std::unique_ptr<FastDdsReader> reader(new FastDdsReader(subscriber));
  reader->target_->handler = std::move(handler);
  reader->target_->strand = &strand;
  reader->target_->topic = topic.name;
  reader->target_->counts = std::move(counts);
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
  {
    const std::lock_guard lock(target_->mutex);
    target_->closed = true;
  }
  if (reader_ != nullptr) subscriber_.delete_datareader(reader_);  // waits for our listener
}

void FastDdsReader::Target::run(const std::vector<std::uint8_t>& bytes, const ParticipantId& sender) {
  const std::lock_guard lock(mutex);
  if (closed) return;
  if (!handler(bytes, SampleInfo{sender, strand->now()})) {
    counts->change(topic, sender, [](TopicCount& c) { ++c.malformed; });
  }
}

void FastDdsReader::on_data_available(dds::DataReader* reader) {
  for (;;) {
    Bytes bytes;
    dds::SampleInfo info;
    try {
      if (reader->take_next_sample(&bytes, &info) != ReturnCode_t::RETCODE_OK) return;
    } catch (const std::exception&) {
      target_->counts->change(target_->topic, {}, [](TopicCount& c) { ++c.malformed; });
      return;
    }
    if (!info.valid_data) continue;
    const rtps::GUID_t writer = rtps::iHandle2GUID(info.publication_handle);
    ParticipantId sender{};
    std::copy(std::begin(writer.guidPrefix.value), std::end(writer.guidPrefix.value), sender.begin());
    target_->counts->change(target_->topic, sender, [&](TopicCount& c) {
      ++c.samples_in;
      c.bytes_in += WireCost::sample(bytes.in.size());
      if (bytes.too_long) ++c.malformed;
    });
    if (bytes.too_long) continue;
    target_->strand->post([target = target_,
                           in = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes.in)),
                           sender] { target->run(*in, sender); });
  }
}

void FastDdsReader::on_sample_lost(dds::DataReader*, const dds::SampleLostStatus& status) {
  // Which writer's is not said here.
  target_->counts->change(target_->topic, {}, [&](TopicCount& c) {
    c.lost += static_cast<std::uint64_t>(std::max(0, status.total_count_change));
  });
}

}  // namespace adit::wire

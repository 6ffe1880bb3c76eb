// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <atomic>
#include <map>
#include <mutex>

#include "core/exec/in_place.hpp"
#include "core/wire/fastdds/bytes_type.hpp"
#include "core/wire/mailbox.hpp"
#include "core/wire/participant.hpp"

namespace adit::wire {

struct TransportContext;

/// Counters of one participant; the application's strands and Fast DDS's threads update them.
class SharedCounts {
 public:
  template <class Change>
  void change(const std::string& topic, const ParticipantId& peer, Change change) {
    const std::lock_guard lock(mutex_);
    auto found = counts_.find({topic, peer});
    if (found == counts_.end()) {
      // Peers come and go for days: beyond the bound they share one entry.
      const ParticipantId counted = counts_.size() < kMaxCounts ? peer : ParticipantId{};
      found = counts_.try_emplace({topic, counted}).first;
      found->second.topic = topic;
      found->second.peer = counted;
    }
    change(found->second);
  }
  std::vector<TopicCount> all() const;

 private:
  static constexpr std::size_t kMaxCounts = 4096;
  mutable std::mutex mutex_{};
  std::map<std::pair<std::string, ParticipantId>, TopicCount> counts_{};
};

/// One Fast DDS DataWriter.
class FastDdsWriter final : public RawWriter, private eprosima::fastdds::dds::DataWriterListener {
 public:
  static Result<std::unique_ptr<RawWriter>> make(eprosima::fastdds::dds::Publisher& publisher,
                                                 eprosima::fastdds::dds::Topic& dds_topic,
                                                 const TopicInfo& topic, std::shared_ptr<SharedCounts> counts,
                                                 std::shared_ptr<TransportContext> context);
  ~FastDdsWriter() override;
  Result<void> write(std::span<const std::uint8_t> cdr) override;
  std::size_t matched() const override { return static_cast<std::size_t>(matched_.load()); }

 private:
  FastDdsWriter(eprosima::fastdds::dds::Publisher& publisher, const TopicInfo& topic,
                std::shared_ptr<SharedCounts> counts);
  void on_publication_matched(eprosima::fastdds::dds::DataWriter* writer,
                              const eprosima::fastdds::dds::PublicationMatchedStatus& status) override;
  Result<void> failed(Reason reason, const std::string& why);

  eprosima::fastdds::dds::Publisher& publisher_;
  eprosima::fastdds::dds::DataWriter* writer_{};
  std::string topic_;
  bool keyed_;
  std::uint32_t max_bytes_;
  std::shared_ptr<SharedCounts> counts_;
  std::shared_ptr<TransportContext> context_{};
  std::uint32_t entity_{};
  int own_{};  ///< Matched readers of this participant, which receive nothing. Only the listener changes it.
  std::atomic<int> matched_{0};
};

/// One Fast DDS DataReader. It takes samples on Fast DDS's threads into a mailbox, which the reader's strand
/// empties. Samples of the same participant are left out.
class FastDdsReader final : public RawReader, private eprosima::fastdds::dds::DataReaderListener {
 public:
  static Result<std::unique_ptr<RawReader>> make(eprosima::fastdds::dds::Subscriber& subscriber,
                                                 eprosima::fastdds::dds::Topic& dds_topic,
                                                 const TopicInfo& topic, std::shared_ptr<SharedCounts> counts,
                                                 Executor& strand, RawHandler handler);
  /// On return the handler is not running and will not run again.
  ~FastDdsReader() override;

 private:
  using Buffer = std::vector<std::uint8_t>;
  using Box = Mailbox<Buffer>;

  /// State that a task on the strand needs; it outlives the reader while such a task is queued.
  struct Target : std::enable_shared_from_this<Target> {
    Target(const TopicInfo& topic, std::shared_ptr<SharedCounts> counts, Executor& strand,
           RawHandler handler);
    /// Returns a buffer to receive into; reuses one whose sample was handled. Safe to call from any thread.
    Buffer buffer();
    /// Adds a sample. Safe to call from any thread.
    void put(Box::Entry entry);
    /// Posts a task that handles the samples in the mailbox; at most one such task is queued at a time. Safe
    /// to call from any thread.
    void notify();
    void close();
    void handle();

    const std::string topic;
    const bool keyed;
    const std::uint32_t max_bytes;
    const std::shared_ptr<SharedCounts> counts;

   private:
    void post();
    bool handle_one();
    void recycle(Buffer buffer);

    Executor& strand_;
    InPlace* in_place_;  ///< Null: samples are posted to the strand.
    RawHandler handler_;
    std::recursive_mutex handling_{};  // Recursive, because a handler may destroy its own reader.
    std::mutex mutex_{};               // Guards the members below.
    Box mailbox_;
    std::vector<Buffer> spare_{};
    bool posted_{};
    bool closed_{};
  };

  explicit FastDdsReader(eprosima::fastdds::dds::Subscriber& subscriber) : subscriber_(subscriber) {}
  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
  void on_sample_lost(eprosima::fastdds::dds::DataReader* reader,
                      const eprosima::fastdds::dds::SampleLostStatus& status) override;

  eprosima::fastdds::dds::Subscriber& subscriber_;
  eprosima::fastdds::dds::DataReader* reader_{};
  std::shared_ptr<Target> target_{};
};

}  // namespace adit::wire

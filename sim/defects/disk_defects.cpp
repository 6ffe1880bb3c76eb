// SPDX-License-Identifier: Apache-2.0
// Defects of what survives a restart, made of the disk and of the seed of the epoch.
#include "core/findings/finding.hpp"
#include "core/store/sections.hpp"
#include "core/wire/cdr_key.hpp"
#include "robot_agent/state/restored.hpp"
#include "sim/defects/decorations.hpp"
#include "sim/defects/disk_filter.hpp"

namespace adit::sim {
namespace {

/// Reads the agent's state without its lock.
class ForgetsLock final : public DiskFilter {
 public:
  explicit ForgetsLock(const Subject& subject) : DiskFilter(subject.disk) {}
  Result<std::optional<store::Bytes>> on_read(const std::string& name, std::size_t max_bytes) const override {
    auto bytes = DiskFilter::on_read(name, max_bytes);
    if (name != agent::kStateFile || !bytes || !*bytes) return bytes;
    const store::State state = store::decode_envelope(agent::kSnapshotFormat, **bytes);
    auto read = agent::decode_snapshot(state.payload);
    if (state.found != store::LoadStatus::good || !read) return bytes;
    read->snapshot.authority.locked = false;
    return std::optional(
        store::encode_envelope(agent::kSnapshotFormat, state.generation, agent::encode(read->snapshot)));
  }
};

/// Reads an earlier state with a damaged byte in its last entry, as a program does that takes either every
/// entry or none: it finds no entry.
class LosesAllState final : public DiskFilter {
 public:
  explicit LosesAllState(const Subject& subject) : DiskFilter(subject.disk) {}
  Result<std::optional<store::Bytes>> on_read(const std::string& name, std::size_t max_bytes) const override {
    auto bytes = DiskFilter::on_read(name, max_bytes);
    if (name != agent::kStateFile || !bytes || !*bytes) return bytes;
    store::State state = store::decode_envelope(agent::kSnapshotFormat, **bytes);
    if (state.found != store::LoadStatus::good || state.payload.size() <= kChecksum) return bytes;
    state.payload[state.payload.size() - kChecksum - 1] ^= 0xff;
    if (!store::unpack_sections(state.payload).damaged.empty()) lose_directory(state.payload);
    store::Bytes read = store::encode_envelope(agent::kSnapshotFormat, state.generation, state.payload);
    read.back() ^= 0xff;  // The checksum of the file does not match what is damaged.
    return std::optional(std::move(read));
  }

 private:
  static constexpr std::size_t kChecksum = 4;  ///< Bytes, behind each entry.

  /// Overwrites all that is in front of the entries, which says where they are.
  static void lose_directory(store::Bytes& payload) {
    const store::SectionList list = store::unpack_sections(payload);
    std::size_t entries = list.damaged.size() * kChecksum;
    for (const store::Section& section : list.good) entries += section.payload.size() + kChecksum;
    for (std::size_t at = 0; at + entries < payload.size(); ++at) payload[at] = 0xff;
  }
};

/// Says that the state is written, and writes it every 5 s alone.
class AcknowledgesEarly final : public DiskFilter {
 public:
  explicit AcknowledgesEarly(const Subject& subject)
      : DiskFilter(subject.disk), strand_(subject.runtime.strand("defect")) {
    timer_ = strand_->every(5s, [this] { write(); });
  }
  ~AcknowledgesEarly() override { strand_->end(); }
  Result<void> on_replace(const std::string& name, const store::Bytes& bytes) override {
    if (name != agent::kStateFile) return DiskFilter::on_replace(name, bytes);
    waiting_ = bytes;
    return {};
  }

 private:
  void write() {
    if (waiting_) (void)inner().replace(agent::kStateFile, *waiting_);  // what fails is lost, too
    waiting_.reset();
  }
  std::shared_ptr<Strand> strand_;
  std::optional<store::Bytes> waiting_{};
  Timer timer_{};
};

/// A decoration of the robot's disk by a filter; nothing when the robot has none.
template <class Filter>
Decoration on_disk(const Subject& subject) {
  Decoration decoration;
  if (subject.disk) decoration.disk = std::make_shared<Filter>(subject);
  return decoration;
}

}  // namespace

namespace decorations {

Decoration epoch_kept_at_restart(const Subject& subject) {
  Decoration decoration;
  decoration.parameters = [seed = wire::key_number(subject.robot)](agent::AgentParams& params) {
    params.seed = seed;
  };
  return decoration;
}

Decoration lock_forgotten(const Subject& subject) { return on_disk<ForgetsLock>(subject); }
Decoration acknowledged_lost(const Subject& subject) { return on_disk<AcknowledgesEarly>(subject); }
Decoration state_lost_whole(const Subject& subject) { return on_disk<LosesAllState>(subject); }

Decoration findings_deleted_at_start(const Subject& subject) {
  if (!subject.disk) return {};
  const auto names = subject.disk->list();
  if (!names) return {};
  for (const std::string& name : *names)
    if (findings::is_finding_file(name)) (void)subject.disk->remove(name);  // a full disk removes, too
  return {};
}

}  // namespace decorations
}  // namespace adit::sim

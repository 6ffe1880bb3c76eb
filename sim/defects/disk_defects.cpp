// Defects of what survives a restart, made of the disk and of the seed of the epoch.
#include <string_view>

#include "core/findings/finding.hpp"
#include "robot_agent/state/restored.hpp"
#include "sim/defects/decorations.hpp"
#include "sim/defects/disk_filter.hpp"

namespace adit::sim {
namespace {

/// Reads the agent's state without its lock.
class ForgetsLock final : public DiskFilter {
 public:
  using DiskFilter::DiskFilter;
  Result<std::optional<store::Bytes>> on_read(const std::string& name, std::size_t most) const override {
    auto bytes = DiskFilter::on_read(name, most);
    if (name != agent::kStateFile || !bytes || !*bytes) return bytes;
    const store::State state = store::unseal(agent::kSnapshotFormat, **bytes);
    auto read = agent::decode_snapshot(state.payload);
    if (state.found != store::Found::good || !read) return bytes;
    read->snapshot.authority.locked = false;
    return std::optional(
        store::seal(agent::kSnapshotFormat, state.generation, agent::encode(read->snapshot)));
  }
};

/// Reads an earlier state as one that makes no sense.
class LosesStateWhole final : public DiskFilter {
 public:
  using DiskFilter::DiskFilter;
  Result<std::optional<store::Bytes>> on_read(const std::string& name, std::size_t most) const override {
    auto bytes = DiskFilter::on_read(name, most);
    if (name == agent::kStateFile && bytes && *bytes) (*bytes)->resize((*bytes)->size() / 8);
    return bytes;
  }
};

/// Says that the state is written, and writes it every 5 s alone.
class AcknowledgesEarly final : public DiskFilter {
 public:
  AcknowledgesEarly(std::shared_ptr<store::Disk> inner, std::shared_ptr<Strand> strand)
      : DiskFilter(std::move(inner)), strand_(std::move(strand)) {
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

std::uint64_t number(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return hash;
}

}  // namespace

namespace decorations {

Decoration epoch_kept_at_restart(const Subject& subject) {
  Decoration decoration;
  decoration.parameters = [seed = number(subject.robot)](agent::AgentParams& params) { params.seed = seed; };
  return decoration;
}

Decoration lock_forgotten(const Subject& subject) {
  Decoration decoration;
  if (subject.disk) decoration.disk = std::make_shared<ForgetsLock>(subject.disk);
  return decoration;
}

Decoration acknowledged_lost(const Subject& subject) {
  Decoration decoration;
  if (subject.disk)
    decoration.disk = std::make_shared<AcknowledgesEarly>(subject.disk, subject.runtime.strand("defect"));
  return decoration;
}

Decoration state_lost_whole(const Subject& subject) {
  Decoration decoration;
  if (subject.disk) decoration.disk = std::make_shared<LosesStateWhole>(subject.disk);
  return decoration;
}

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

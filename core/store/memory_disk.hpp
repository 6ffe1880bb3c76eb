#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "core/store/disk.hpp"
#include "core/time/random.hpp"

namespace adit::store {

/// A disk of a rehearsal. It outlives the agent whose crash is played: what was written stays. A power cut
/// takes from it what was not synced, as a real one may: whole, in part, or replaced by zeros, and names that
/// were not synced with their folder from the last one backwards. Which of it is drawn from the seed.
class MemoryDisk final : public Disk {
 public:
  explicit MemoryDisk(std::uint64_t seed = 1, std::uint64_t capacity = std::uint64_t{16} << 20)
      : random_(seed), capacity_(capacity) {}

  /// Nothing fits any more, as long as it is set; a write stops halfway.
  void set_full(bool full);
  /// Every access to that file fails, as on a bad block or an immutable file, as long as it is set.
  void set_refused(const std::string& name, bool refused);
  /// Power fails within the writes to come: after `steps` more of them, where each byte written is one, and
  /// so is each opening, sync, rename and removal. Every call fails from then on, until power_up().
  void cut_power_after(std::uint64_t steps);
  /// Power fails now.
  void cut_power() { cut_power_after(0); }
  /// What survived is there again.
  void power_up();
  bool powered() const;
  /// Steps done so far, as cut_power_after() counts them.
  std::uint64_t steps() const;
  /// Puts bytes there as they are, durable: what a failing device or another program left.
  void plant(const std::string& name, Bytes bytes);

  Result<std::vector<std::string>> list() const override;
  std::uint64_t free() const override;
  bool instant() const override { return true; }
  std::string where() const override { return "memory"; }

 protected:
  Result<std::optional<Bytes>> read_file(const std::string& name, std::size_t max_bytes) const override;
  Result<void> write_file(const std::string& name, std::span<const std::uint8_t> bytes, bool append) override;
  Result<void> rename_file(const std::string& from, const std::string& to) override;
  Result<void> remove_file(const std::string& name) override;
  Result<void> sync_folder() override;

 private:
  struct File {
    Bytes cached{};   ///< what a program reads
    Bytes durable{};  ///< what a power cut cannot take
  };
  using Folder = std::map<std::string, std::shared_ptr<File>>;

  bool step();
  bool refuses(const std::string& name) const;
  std::uint64_t used() const;
  void changed() { history_.push_back(names_); }
  void survive(File& file);

  mutable std::mutex mutex_{};
  Random random_;
  std::uint64_t capacity_;
  bool full_{};
  std::set<std::string> refused_{};
  std::optional<std::uint64_t> fuse_{};  ///< steps until the power fails
  bool powered_{true};
  std::uint64_t steps_{};
  Folder names_{};                   ///< what a program sees
  std::vector<Folder> history_{{}};  ///< the durable folder, then one for each change not synced
};

}  // namespace adit::store

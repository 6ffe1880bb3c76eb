// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "core/store/disk.hpp"
#include "core/time/random.hpp"

namespace adit::store {

/// A simulated disk for rehearsals. It outlives an agent whose crash is simulated, and written data remains.
/// A power cut removes data that was not synced, as on a real disk: completely, in part, or replaced by
/// zeros, and names that were not synced with their folder from the last one backwards. The seed determines
/// what is lost.
class MemoryDisk final : public Disk {
 public:
  explicit MemoryDisk(std::uint64_t seed = 1, std::uint64_t capacity = std::uint64_t{16} << 20)
      : random_(seed), capacity_(capacity) {}

  /// Makes the disk full while set; a write then stops halfway.
  void set_full(bool full);
  /// Makes every access to that file fail while set, as on a bad block or an immutable file.
  void set_refused(const std::string& name, bool refused);
  /// Cuts the power after `steps` more write steps: each byte written is one step, and so is each opening,
  /// sync, rename and removal. Every call fails from then on, until power_up().
  void cut_power_after(std::uint64_t steps);
  /// Cuts the power now.
  void cut_power() { cut_power_after(0); }
  /// Restores the power; surviving data is readable again.
  void power_up();
  bool powered() const;
  /// Number of steps so far, as cut_power_after() counts them.
  std::uint64_t steps() const;
  /// Stores bytes unchanged and durably, as a failing device or another program would leave them.
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
    Bytes cached{};   ///< Content that a program reads.
    Bytes durable{};  ///< Content that survives a power cut.
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
  std::optional<std::uint64_t> fuse_{};  ///< Steps until the power fails.
  bool powered_{true};
  std::uint64_t steps_{};
  Folder names_{};                   ///< Names that a program sees.
  std::vector<Folder> history_{{}};  ///< The durable folder, then one state for each change not synced.
};

}  // namespace adit::store

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/store/disk.hpp"

namespace adit::store {

/// A folder of a real file system. Only the owner can access the files (0600) and the folder (0700).
class FileDisk final : public Disk {
 public:
  /// Creates the folder with its parents, and removes temporary files that a crash left. Errors: cannot_write
  /// when it cannot be created or used.
  static Result<std::shared_ptr<FileDisk>> open(const std::string& folder);
  ~FileDisk() override;

  Result<std::vector<std::string>> list() const override;
  std::uint64_t free() const override;
  std::string where() const override { return folder_; }

 protected:
  Result<std::optional<Bytes>> read_file(const std::string& name, std::size_t max_bytes) const override;
  Result<void> write_file(const std::string& name, std::span<const std::uint8_t> bytes, bool append) override;
  Result<void> rename_file(const std::string& from, const std::string& to) override;
  Result<void> remove_file(const std::string& name) override;
  Result<void> sync_folder() override;

 private:
  FileDisk(std::string folder, int fd) : folder_(std::move(folder)), fd_(fd) {}
  Error failed(Reason reason, const std::string& doing, const std::string& name) const;
  std::string folder_;
  int fd_;  ///< Descriptor of the folder: all paths are relative to it, even when its path changes.
};

}  // namespace adit::store

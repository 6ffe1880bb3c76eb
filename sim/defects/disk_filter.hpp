// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>

#include "core/store/disk.hpp"

namespace adit::sim {

/// A disk in front of another one. A class derived from it changes what is read and what is written.
class DiskFilter : public store::Disk {
 public:
  explicit DiskFilter(std::shared_ptr<store::Disk> inner) : inner_(std::move(inner)) {}

  Result<std::vector<std::string>> list() const override { return inner_->list(); }
  std::uint64_t free() const override { return inner_->free(); }
  bool instant() const override { return inner_->instant(); }
  std::string where() const override { return inner_->where(); }

 protected:
  /// A file's bytes as the agent reads them; nothing when it finds no such file.
  virtual Result<std::optional<store::Bytes>> on_read(const std::string& name, std::size_t max_bytes) const {
    return inner_->read(name, max_bytes);
  }
  /// The agent replaces a file by those bytes.
  virtual Result<void> on_replace(const std::string& name, const store::Bytes& bytes) {
    return inner_->replace(name, bytes);
  }
  store::Disk& inner() const { return *inner_; }

 private:
  Result<std::optional<store::Bytes>> read_file(const std::string& name, std::size_t max_bytes) const final;
  Result<void> write_file(const std::string& name, std::span<const std::uint8_t> bytes, bool append) final;
  Result<void> rename_file(const std::string& from, const std::string& to) final;
  Result<void> remove_file(const std::string& name) final;
  Result<void> sync_folder() final { return {}; }

  std::shared_ptr<store::Disk> inner_;
  std::map<std::string, store::Bytes> temporary_{};  ///< Written, and not renamed to a file yet
};

}  // namespace adit::sim

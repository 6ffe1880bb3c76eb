// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

/// Durable storage: data that must survive the end of a process, and a power cut.
namespace adit::store {

using Bytes = std::vector<std::uint8_t>;

/// One folder of durable files. This class defines the order of steps that makes a write durable; FileDisk
/// and MemoryDisk implement only the steps. Safe to call from any thread, but each file from one thread at a
/// time. Every error is cannot_read or cannot_write (bad_argument for a name) and leaves the old file
/// unchanged.
class Disk {
 public:
  virtual ~Disk() = default;
  Disk() = default;
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// Reads a complete file; nothing when there is no such file. More than `max_bytes` bytes: cannot_read.
  Result<std::optional<Bytes>> read(const std::string& name, std::size_t max_bytes = kMaxBytes) const;
  /// Replaces a file atomically and durably: temporary file, sync of its data, rename, sync of the folder.
  /// After a power cut at any step the file is the old one or the new one.
  Result<void> replace(const std::string& name, std::span<const std::uint8_t> bytes);
  /// Appends to a file; durable on return. After a power cut during the call, the appended bytes may be
  /// missing or contain anything.
  Result<void> append(const std::string& name, std::span<const std::uint8_t> bytes);
  /// Removes a file; durable on return. Without such a file it does nothing.
  Result<void> remove(const std::string& name);
  /// Renames a file; an existing file of the new name is replaced. Durable on return.
  Result<void> rename(const std::string& from, const std::string& to);
  /// Returns the sorted file names, without temporary files.
  virtual Result<std::vector<std::string>> list() const = 0;
  /// Free space, bytes.
  virtual std::uint64_t free() const = 0;
  /// True: writes take no time and must run on the caller's strand, so that a rehearsal orders them.
  virtual bool instant() const { return false; }
  /// Location of the folder, for users.
  virtual std::string where() const = 0;

  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

 protected:
  virtual Result<std::optional<Bytes>> read_file(const std::string& name, std::size_t max_bytes) const = 0;
  /// Truncates a file, or (`append`) continues it, writes to it and syncs its data. Its name is not durable
  /// yet.
  virtual Result<void> write_file(const std::string& name, std::span<const std::uint8_t> bytes,
                                  bool append) = 0;
  virtual Result<void> rename_file(const std::string& from, const std::string& to) = 0;
  virtual Result<void> remove_file(const std::string& name) = 0;
  virtual Result<void> sync_folder() = 0;
};

/// Whether a name is valid: 1 to 128 of [A-Za-z0-9_.-], not beginning with a dot.
bool valid_file_name(std::string_view name);
/// Whether a name is that of a temporary file of ours, which a crash can leave behind.
bool is_temporary(std::string_view name);

}  // namespace adit::store

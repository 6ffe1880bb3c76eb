#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

/// What has to survive the end of a process, and a power cut.
namespace adit::store {

using Bytes = std::vector<std::uint8_t>;

/// One folder of durable files. The order of steps that makes a write durable is written once, here;
/// FileDisk and MemoryDisk only do the steps. Safe to call from any thread, a file from one thread at a time.
/// Every error is cannot_read or cannot_write (bad_argument for a name) and leaves the old file as it was.
class Disk {
 public:
  virtual ~Disk() = default;
  Disk() = default;
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// Whole content; nothing when there is no such file. Longer than `most` bytes: cannot_read.
  Result<std::optional<Bytes>> read(const std::string& name, std::size_t max_bytes = kMaxBytes) const;
  /// Atomic and durable: temporary file, its data synced, renamed, the folder synced. After a power cut
  /// anywhere in it the file is the old one or the new one.
  Result<void> replace(const std::string& name, std::span<const std::uint8_t> bytes);
  /// Durable when it returns. After a power cut in it, the end of the file may be missing or anything.
  Result<void> append(const std::string& name, std::span<const std::uint8_t> bytes);
  /// Durable when it returns. No such file: nothing happens.
  Result<void> remove(const std::string& name);
  /// Gives a file another name; a file of that name is replaced. Durable when it returns.
  Result<void> rename(const std::string& from, const std::string& to);
  /// Names, sorted. Temporary files are not among them.
  virtual Result<std::vector<std::string>> list() const = 0;
  /// Bytes that still fit.
  virtual std::uint64_t free() const = 0;
  /// True: writes take no time and belong on the caller's strand, so that a rehearsal orders them.
  virtual bool instant() const { return false; }
  /// Where it is, for people.
  virtual std::string where() const = 0;

  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

 protected:
  virtual Result<std::optional<Bytes>> read_file(const std::string& name, std::size_t max_bytes) const = 0;
  /// Writes to a file, which is emptied before or (`append`) goes on, and syncs its data. Its name is not
  /// durable yet.
  virtual Result<void> write_file(const std::string& name, std::span<const std::uint8_t> bytes,
                                  bool append) = 0;
  virtual Result<void> rename_file(const std::string& from, const std::string& to) = 0;
  virtual Result<void> remove_file(const std::string& name) = 0;
  virtual Result<void> sync_folder() = 0;
};

/// 1 to 64 of [A-Za-z0-9_.-], not beginning with a dot.
bool valid_file_name(std::string_view name);
/// A temporary file of ours: what a crash can leave behind.
bool is_temporary(std::string_view name);

}  // namespace adit::store

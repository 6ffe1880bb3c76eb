// SPDX-License-Identifier: Apache-2.0
#include "core/store/file_disk.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace adit::store {
namespace {

/// File descriptor that its owner closes.
class Fd {
 public:
  explicit Fd(int fd) : fd_(fd) {}
  ~Fd() {
    if (fd_ >= 0) ::close(fd_);
  }
  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;
  int get() const { return fd_; }
  /// Returns false when the file system reports a late error; the descriptor is closed in any case.
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

bool write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(fd, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

/// Syncs a folder. Returns true also for a folder that we may write to but not read, which cannot be synced.
bool sync_folder_at(const std::filesystem::path& folder) {
  const Fd fd(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return fd ? ::fsync(fd.get()) == 0 : errno == EACCES;
}

/// Creates the folders of a path. Each one is made durable before the next, as its entry is in its parent.
bool make_folders(const std::filesystem::path& folder) {
  std::filesystem::path made;
  for (const auto& part : folder) {
    const std::filesystem::path parent = made;
    made /= part;
    if (::mkdir(made.c_str(), 0700) == 0) {
      if (!sync_folder_at(parent)) return false;
    } else if (errno != EEXIST && errno != EISDIR && errno != EROFS) {
      return false;
    }
  }
  return true;
}

}  // namespace

Error FileDisk::failed(Reason reason, const std::string& doing, const std::string& name) const {
  return {reason, "cannot " + doing + " " + folder_ + "/" + name + ": " + std::strerror(errno)};
}

Result<std::shared_ptr<FileDisk>> FileDisk::open(const std::string& folder) {
  const auto error = [&folder](const char* doing) {
    return Error{Reason::cannot_write,
                 "cannot " + std::string(doing) + " the folder " + folder + ": " + std::strerror(errno)};
  };
  if (!make_folders(folder)) return error("make");
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return error("open");
  std::shared_ptr<FileDisk> disk(new FileDisk(folder, fd));
  if (::faccessat(fd, ".", W_OK | X_OK, AT_EACCESS) != 0) return error("write to");
  std::error_code unread;  // When the folder cannot be listed here, list() reports it later.
  for (std::filesystem::directory_iterator it(folder, unread), end; !unread && it != end;
       it.increment(unread))
    if (const std::string name = it->path().filename(); is_temporary(name)) (void)disk->remove_file(name);
  return disk;
}

FileDisk::~FileDisk() { ::close(fd_); }

Result<std::vector<std::string>> FileDisk::list() const {
  std::error_code error;
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error))
    if (it->symlink_status(error).type() == std::filesystem::file_type::regular &&
        valid_file_name(it->path().filename().string()))
      names.push_back(it->path().filename().string());
  if (error) return {Reason::cannot_read, "cannot list " + folder_ + ": " + error.message()};
  std::sort(names.begin(), names.end());
  return names;
}

std::uint64_t FileDisk::free() const {
  struct statvfs status {};
  return ::fstatvfs(fd_, &status) == 0 ? std::uint64_t{status.f_bavail} * status.f_frsize : 0;
}

Result<std::optional<Bytes>> FileDisk::read_file(const std::string& name, std::size_t max_bytes) const {
  // Non-blocking, so that a pipe of that name does not block the caller.
  const Fd file(::openat(fd_, name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!file && errno == ENOENT) return std::optional<Bytes>{};
  if (!file) return failed(Reason::cannot_read, "open", name);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return failed(Reason::cannot_read, "look at", name);
  if (!S_ISREG(status.st_mode)) return {Reason::cannot_read, folder_ + "/" + name + " is no file"};
  Bytes bytes;
  std::uint8_t block[65536];
  for (;;) {
    const ssize_t got = ::read(file.get(), block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failed(Reason::cannot_read, "read", name);
    if (got == 0) return std::optional<Bytes>{std::move(bytes)};
    bytes.insert(bytes.end(), block, block + got);
    if (bytes.size() > max_bytes)
      return {Reason::cannot_read,
              folder_ + "/" + name + " is longer than " + std::to_string(max_bytes) + " bytes"};
  }
}

Result<void> FileDisk::write_file(const std::string& name, std::span<const std::uint8_t> bytes, bool append) {
  const int how = O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | (append ? O_APPEND : O_TRUNC);
  Fd file(::openat(fd_, name.c_str(), how, 0600));
  if (!file || !write_all(file.get(), bytes)) return failed(Reason::cannot_write, "write", name);
  // Uses the descriptor that wrote: another one may not receive a write-back error.
  if (::fsync(file.get()) != 0) return failed(Reason::cannot_write, "sync", name);
  if (!file.close()) return failed(Reason::cannot_write, "close", name);
  return {};
}

Result<void> FileDisk::rename_file(const std::string& from, const std::string& to) {
  if (::renameat(fd_, from.c_str(), fd_, to.c_str()) != 0) return failed(Reason::cannot_write, "rename", to);
  return {};
}

Result<void> FileDisk::remove_file(const std::string& name) {
  if (::unlinkat(fd_, name.c_str(), 0) != 0 && errno != ENOENT)
    return failed(Reason::cannot_write, "remove", name);
  return {};
}

Result<void> FileDisk::sync_folder() {
  if (::fsync(fd_) != 0) return failed(Reason::cannot_write, "sync", "");
  return {};
}

}  // namespace adit::store

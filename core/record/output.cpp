// SPDX-License-Identifier: Apache-2.0
#include "core/record/output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace adit::record {
namespace {

class FileOutput final : public Output {
 public:
  FileOutput(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;
  ~FileOutput() override { ::close(fd_); }

  Result<void> append(ByteSpan data) override {
    while (!data.empty()) {
      const ssize_t size = ::write(fd_, data.data(), data.size());
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) return {Reason::cannot_write, "cannot write " + path_ + ": " + std::strerror(errno)};
      data = data.subspan(static_cast<std::size_t>(size));
    }
    return {};
  }

 private:
  int fd_;
  std::string path_;
};

}  // namespace

Result<std::unique_ptr<Output>> open_file(const std::string& path, bool may_exist) {
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (may_exist ? O_TRUNC : O_EXCL);
  const int fd = ::open(path.c_str(), flags, 0600);
  if (fd < 0)
    return Error{errno == EEXIST ? Reason::in_use : Reason::cannot_write,
                 "cannot write " + path + ": " + std::strerror(errno)};
  return std::unique_ptr<Output>(std::make_unique<FileOutput>(fd, path));
}

}  // namespace adit::record

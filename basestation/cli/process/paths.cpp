// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/process/paths.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "basestation/cli/process/file.hpp"

namespace adit::station::cli {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string because() { return std::string(": ") + std::strerror(errno); }

Result<std::string> private_folder(const std::string& path) {
  std::error_code ignored;  // mkdir() below reports the error.
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    return {Reason::cannot_write, "cannot make the folder " + path + because()};
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISDIR(status.st_mode))
    return {Reason::cannot_write, path + " is not a folder; move it away"};
  if (status.st_uid != ::geteuid()) return {Reason::cannot_write, path + " belongs to another user"};
  if ((status.st_mode & 077) != 0 && ::chmod(path.c_str(), 0700) != 0)
    return {Reason::cannot_write, path + " is open to others; type chmod 700 " + path};
  return path;
}

Result<Id> read_id(const std::string& path) {
  File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) return {Reason::cannot_read, "cannot read " + path + because()};
  char text[64];
  const ssize_t size = ::read(file.get(), text, sizeof text);
  Id id{};
  bool good = size == 33 && text[32] == '\n';
  for (std::size_t i = 0; good && i < 32; ++i) {
    const char* digits = "0123456789abcdef";
    const char* digit = text[i] != 0 ? std::strchr(digits, text[i]) : nullptr;
    good = digit != nullptr;
    if (good) id[i / 2] = static_cast<std::uint8_t>((id[i / 2] << 4) | (digit - digits));
  }
  if (!good) return {Reason::malformed, path + " is damaged; remove it and the station gets a new identity"};
  return id;
}

}  // namespace

Result<std::string> runtime_folder() {
  const std::string base = variable("XDG_RUNTIME_DIR");
  return private_folder(base.empty() ? "/tmp/adit-" + std::to_string(::geteuid()) : base + "/adit");
}

Result<std::string> state_folder() {
  const std::string base = variable("XDG_STATE_HOME");
  if (!base.empty()) return private_folder(base + "/adit");
  const std::string home = variable("HOME");
  if (home.empty())
    return {Reason::cannot_write, "set HOME or XDG_STATE_HOME: the station keeps its identity there"};
  return private_folder(home + "/.local/state/adit");
}

Result<Id> station_id(const std::string& name) {
  auto folder = state_folder();
  if (!folder) return folder.error();
  const std::string path = *folder + "/" + name + ".id";
  if (::access(path.c_str(), F_OK) == 0) return read_id(path);

  Id id{};
  if (::getrandom(id.data(), id.size(), 0) != static_cast<ssize_t>(id.size()))
    return {Reason::internal, "the system gives no random numbers" + because()};
  std::string text;
  for (const std::uint8_t byte : id)
    for (const int nibble : {byte >> 4, byte & 15}) text += "0123456789abcdef"[nibble];
  text += '\n';
  std::string scratch = path + ".XXXXXX";
  File file(::mkostemp(scratch.data(), O_CLOEXEC));  // Mode 0600.
  if (!file) return {Reason::cannot_write, "cannot write in " + *folder + because()};
  const bool written = ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       ::fsync(file.get()) == 0;
  // link() does not replace: if two processes start at the same time, the first one's identity stays.
  const bool placed = written && (::link(scratch.c_str(), path.c_str()) == 0 || errno == EEXIST);
  const std::string why = because();
  ::unlink(scratch.c_str());
  if (!placed) return {Reason::cannot_write, "cannot write " + path + why};
  return read_id(path);
}

}  // namespace adit::station::cli

// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/paths.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "basestation/client/file.hpp"

namespace adit::station::client {
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

Result<std::string> socket_path(const std::string& name) {
  auto folder = runtime_folder();
  if (!folder) return folder.error();
  return *folder + "/" + name + ".sock";
}

}  // namespace adit::station::client

// SPDX-License-Identifier: Apache-2.0
#include "basestation/host/identity.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "basestation/client/file.hpp"
#include "basestation/client/paths.hpp"

namespace adit::station::host {
namespace {

using client::File;

std::string because() { return std::string(": ") + std::strerror(errno); }

Result<Id> read_id(const std::string& path) {
  File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) return {Reason::cannot_read, "cannot read " + path + because()};
  char text[64];
  const ssize_t size = ::read(file.get(), text, sizeof text);
  Id id{};
  bool good = size == 33 && text[32] == '\n';
  for (std::size_t i = 0; good && i < id.size(); ++i) {
    const char* digits = text + 2 * i;
    good = std::from_chars(digits, digits + 2, id[i], 16).ptr == digits + 2;
  }
  if (!good) return {Reason::malformed, path + " is damaged; remove it and the station gets a new identity"};
  return id;
}

}  // namespace

Result<Id> station_id(const std::string& name) {
  auto folder = client::state_folder();
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

}  // namespace adit::station::host

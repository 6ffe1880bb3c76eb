// SPDX-License-Identifier: Apache-2.0
#include "core/store/disk.hpp"

#include <algorithm>

namespace adit::store {
namespace {

std::string temporary(const std::string& name) { return "." + name + ".new"; }

Result<void> check(const std::string& name) {
  if (valid_file_name(name)) return {};
  return {Reason::bad_argument, "'" + name + "' is no name for a file: 1 to 128 of [A-Za-z0-9_.-]"};
}

}  // namespace

bool valid_file_name(std::string_view name) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= 128 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), good);
}

bool is_temporary(std::string_view name) { return name.starts_with(".") && name.ends_with(".new"); }

Result<std::optional<Bytes>> Disk::read(const std::string& name, std::size_t max_bytes) const {
  if (const auto good = check(name); !good) return good.error();
  return read_file(name, max_bytes);
}

Result<void> Disk::replace(const std::string& name, std::span<const std::uint8_t> bytes) {
  if (auto good = check(name); !good) return good;
  const std::string fresh = temporary(name);
  Result<void> done = write_file(fresh, bytes, false);
  // The data is synced before the rename; otherwise a power cut could leave the new name with an empty file.
  if (done) done = rename_file(fresh, name);
  if (!done) {
    (void)remove_file(fresh);  // The first error is the one to report.
    return done;
  }
  return sync_folder();
}

Result<void> Disk::append(const std::string& name, std::span<const std::uint8_t> bytes) {
  if (auto good = check(name); !good) return good;
  if (auto done = write_file(name, bytes, true); !done) return done;
  return sync_folder();  // The file may be new.
}

Result<void> Disk::rename(const std::string& from, const std::string& to) {
  for (const std::string& name : {from, to})
    if (auto good = check(name); !good) return good;
  if (auto done = rename_file(from, to); !done) return done;
  return sync_folder();
}

Result<void> Disk::remove(const std::string& name) {
  if (auto good = check(name); !good) return good;
  if (auto done = remove_file(name); !done) return done;
  return sync_folder();
}

}  // namespace adit::store

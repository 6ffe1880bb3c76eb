// SPDX-License-Identifier: Apache-2.0
#include "core/store/memory_disk.hpp"

#include <algorithm>

namespace adit::store {
namespace {

Error dead(Reason reason) { return {reason, "the disk has no power"}; }
Error refused(Reason reason, const std::string& name) { return {reason, "the disk refuses " + name}; }
Error missing(const std::string& name) { return {Reason::cannot_write, "no file " + name}; }

}  // namespace

void MemoryDisk::set_full(bool full) {
  const std::lock_guard lock(mutex_);
  full_ = full;
}

void MemoryDisk::set_refused(const std::string& name, bool refused) {
  const std::lock_guard lock(mutex_);
  if (refused)
    refused_.insert(name);
  else
    refused_.erase(name);
}

/// Its temporary file is refused, too, because writes go through it.
bool MemoryDisk::refuses(const std::string& name) const {
  return std::any_of(refused_.begin(), refused_.end(), [&](const std::string& r) {
    return name == r || (is_temporary(name) && name == "." + r + ".new");
  });
}

void MemoryDisk::cut_power_after(std::uint64_t steps) {
  const std::lock_guard lock(mutex_);
  fuse_ = steps;
  if (steps == 0) powered_ = false;
}

void MemoryDisk::power_up() {
  const std::lock_guard lock(mutex_);
  fuse_.reset();
  if (powered_) return;
  powered_ = true;
  // A journal preserves the order of changes to a folder: a prefix of them survives.
  names_ = history_[random_.below(history_.size())];
  for (auto& [name, file] : names_) survive(*file);
  history_ = {names_};
}

void MemoryDisk::survive(File& file) {
  if (file.cached == file.durable) return;
  // Blocks of the page cache reach the disk in any order, independent of the length. Bytes before an append
  // are safe.
  const auto differs =
      std::mismatch(file.cached.begin(), file.cached.end(), file.durable.begin(), file.durable.end());
  const auto safe = static_cast<std::size_t>(differs.first - file.cached.begin());
  const std::size_t from = safe + random_.below(file.cached.size() - safe + 1);
  switch (random_.below(4)) {
    case 0:
      file.cached = file.durable;
      break;
    case 1:
      file.cached.resize(from);
      break;
    case 2:
      std::fill(file.cached.begin() + static_cast<std::ptrdiff_t>(from), file.cached.end(), 0);
      break;
    default:
      break;  // All of it was written back.
  }
  file.durable = file.cached;
}

bool MemoryDisk::powered() const {
  const std::lock_guard lock(mutex_);
  return powered_;
}

std::uint64_t MemoryDisk::steps() const {
  const std::lock_guard lock(mutex_);
  return steps_;
}

void MemoryDisk::plant(const std::string& name, Bytes bytes) {
  const std::lock_guard lock(mutex_);
  auto file = std::make_shared<File>();
  file->cached = file->durable = std::move(bytes);
  for (Folder& folder : history_) folder[name] = file;
  names_[name] = file;
}

/// Counts one step. Returns false when the power is off, or fails before this step.
bool MemoryDisk::step() {
  if (!powered_) return false;
  if (fuse_ && (*fuse_)-- == 0) {
    powered_ = false;
    return false;
  }
  ++steps_;
  return true;
}

std::uint64_t MemoryDisk::used() const {
  std::uint64_t bytes = 0;
  for (const auto& [name, file] : names_) bytes += file->cached.size();
  return bytes;
}

std::uint64_t MemoryDisk::free() const {
  const std::lock_guard lock(mutex_);
  return full_ || used() >= capacity_ ? 0 : capacity_ - used();
}

Result<std::vector<std::string>> MemoryDisk::list() const {
  const std::lock_guard lock(mutex_);
  if (!powered_) return dead(Reason::cannot_read);
  std::vector<std::string> names;
  for (const auto& [name, file] : names_)
    if (!is_temporary(name)) names.push_back(name);
  return names;
}

Result<std::optional<Bytes>> MemoryDisk::read_file(const std::string& name, std::size_t max_bytes) const {
  const std::lock_guard lock(mutex_);
  if (!powered_) return dead(Reason::cannot_read);
  if (refuses(name)) return refused(Reason::cannot_read, name);
  const auto found = names_.find(name);
  if (found == names_.end()) return std::optional<Bytes>{};
  if (found->second->cached.size() > max_bytes)
    return {Reason::cannot_read, name + " is longer than " + std::to_string(max_bytes) + " bytes"};
  return std::optional<Bytes>{found->second->cached};
}

Result<void> MemoryDisk::write_file(const std::string& name, std::span<const std::uint8_t> bytes,
                                    bool append) {
  const std::lock_guard lock(mutex_);
  if (!step()) return dead(Reason::cannot_write);
  if (refuses(name)) return refused(Reason::cannot_write, name);
  if (!names_.contains(name)) {
    names_[name] = std::make_shared<File>();
    changed();
  }
  File& file = *names_[name];
  if (!append) file.cached.clear();
  const std::uint64_t before = used();
  const std::uint64_t room = full_ ? bytes.size() / 2 : before >= capacity_ ? 0 : capacity_ - before;
  for (const std::uint8_t byte : bytes.first(std::min<std::uint64_t>(room, bytes.size()))) {
    if (!step()) return dead(Reason::cannot_write);
    file.cached.push_back(byte);
  }
  if (full_ || room < bytes.size()) return {Reason::cannot_write, "no space left for " + name};
  if (!step()) return dead(Reason::cannot_write);
  file.durable = file.cached;
  return {};
}

Result<void> MemoryDisk::rename_file(const std::string& from, const std::string& to) {
  const std::lock_guard lock(mutex_);
  if (!step()) return dead(Reason::cannot_write);
  const auto found = names_.find(from);
  if (found == names_.end()) return missing(from);
  names_[to] = found->second;
  names_.erase(from);
  changed();
  return {};
}

Result<void> MemoryDisk::remove_file(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (!step()) return dead(Reason::cannot_write);
  if (refuses(name)) return refused(Reason::cannot_write, name);
  if (names_.erase(name) != 0) changed();
  return {};
}

Result<void> MemoryDisk::sync_folder() {
  const std::lock_guard lock(mutex_);
  if (!step()) return dead(Reason::cannot_write);
  history_ = {names_};
  return {};
}

}  // namespace adit::store

// SPDX-License-Identifier: Apache-2.0
#include "core/store/preserve.hpp"

#include <algorithm>

namespace adit::store {
namespace {

constexpr int kMaxCopies = 8;

std::string free_name(const Disk& disk, const std::string& file, std::string_view why) {
  const std::string first = file + "." + std::string(why);
  std::string name = first;
  const auto names = disk.list();
  const auto taken = [&](const std::string& n) {
    return names && std::find(names->begin(), names->end(), n) != names->end();
  };
  for (int i = 2; taken(name) && i <= kMaxCopies; ++i) name = first + "-" + std::to_string(i);
  return name;
}

}  // namespace

std::string set_aside(Disk& disk, const std::string& file, std::string_view why) {
  const std::string name = free_name(disk, file, why);
  return disk.rename(file, name) ? name : std::string{};
}

std::string copy_aside(Disk& disk, const std::string& file, std::string_view why) {
  const auto bytes = disk.read(file);
  if (!bytes || !*bytes) return {};
  const std::string name = free_name(disk, file, why);
  return disk.replace(name, **bytes) ? name : std::string{};
}

}  // namespace adit::store

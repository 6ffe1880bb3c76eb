// SPDX-License-Identifier: Apache-2.0
#include "core/record/ring.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

namespace adit::record {
namespace {

namespace fs = std::filesystem;

struct Segment {
  std::uint64_t number{};
  std::uint64_t bytes{};
  fs::path path{};
};

/// Returns the number in NAME-000001.mcap; nullopt for other files.
std::optional<std::uint64_t> number_in(const std::string& file, const std::string& name) {
  const std::string_view end = ".mcap";
  if (!file.starts_with(name + "-") || !file.ends_with(end)) return std::nullopt;
  const char* first = file.data() + name.size() + 1;
  const char* last = file.data() + file.size() - end.size();
  std::uint64_t number = 0;
  const auto [stop, error] = std::from_chars(first, last, number);
  if (error != std::errc{} || stop != last) return std::nullopt;
  return number;
}

std::vector<Segment> segments_in(const std::string& folder, const std::string& name) {
  std::vector<Segment> out;
  std::error_code failed;  // A folder that cannot be listed causes an error when the file is opened.
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
    if (const auto number = number_in(it->path().filename().string(), name)) {
      std::error_code gone;
      const auto size = it->file_size(gone);
      out.push_back({*number, gone ? 0 : size, it->path()});
    }
  std::sort(out.begin(), out.end(), [](const Segment& a, const Segment& b) { return a.number < b.number; });
  return out;
}

}  // namespace

// The number of files is bounded, too, as files of short runs are small.
Result<std::uint64_t> Ring::make_room() {
  std::error_code failed;
  if (fs::create_directories(params_.folder, failed); failed)
    return Error{Reason::cannot_write, "cannot make the folder " + params_.folder + ": " + failed.message()};
  // When the folder belongs to another user, opening the file fails.
  fs::permissions(params_.folder, fs::perms::owner_all, failed);
  const std::vector<Segment> found = segments_in(params_.folder, params_.name);
  const std::uint64_t limit = static_cast<std::uint64_t>(params_.segments) * params_.segment_bytes;
  const std::size_t max_entries = static_cast<std::size_t>(params_.segments) * 8;
  std::uint64_t bytes = params_.segment_bytes;
  for (const Segment& segment : found) bytes += segment.bytes;
  std::size_t left = found.size() + 1;
  for (const Segment& segment : found) {
    if (bytes <= limit && left <= max_entries) break;
    if (!fs::remove(segment.path, failed) && failed)
      return Error{Reason::cannot_write, "cannot remove " + segment.path.string() + ": " + failed.message()};
    bytes -= segment.bytes;
    --left;
  }
  return found.empty() ? 1 : found.back().number + 1;
}

Result<std::unique_ptr<Output>> Ring::next() {
  const auto number = make_room();
  if (!number) return number.error();
  // Another process may use the same name and folder: then the next number is tried.
  for (std::uint64_t n = *number; n < *number + 100; ++n) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "-%06llu.mcap", static_cast<unsigned long long>(n));
    path_ = params_.folder + "/" + params_.name + digits;
    auto opened = params_.open ? params_.open(path_) : open_file(path_, false);
    if (opened || opened.reason() != Reason::in_use) return opened;
  }
  return Error{Reason::in_use, params_.folder + ": too many recorders of the name " + params_.name};
}

}  // namespace adit::record

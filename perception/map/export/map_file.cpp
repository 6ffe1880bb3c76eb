// SPDX-License-Identifier: Apache-2.0
#include "perception/map/export/map_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include "perception/map/export/grid_file.hpp"
#include "perception/map/export/octree_file.hpp"
#include "perception/map/export/points_file.hpp"

namespace adit::perception {
namespace {

constexpr std::uintmax_t kMaxFile = std::uintmax_t{512} << 20;  ///< Bytes of a file to load.

Error write_failed(const std::filesystem::path& file, int error) {
  return {Reason::cannot_write, file.string() + ": " + std::generic_category().message(error)};
}

/// 0, or the system's error.
int write_synced(const std::filesystem::path& part, const std::string& content) {
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return errno;
  int error = 0;
  for (std::size_t at = 0; at < content.size() && error == 0;) {
    const ssize_t written = ::write(fd, content.data() + at, content.size() - at);
    if (written > 0) at += static_cast<std::size_t>(written);
    if (written == 0) error = ENOSPC;
    if (written < 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && ::fsync(fd) != 0) error = errno;
  if (::close(fd) != 0 && error == 0) error = errno;
  return error;
}

/// The name is durable as far as the file system can; some cannot sync a folder.
void sync_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder =
      file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

Result<void> save_plan(const VoxelImage& image, const std::filesystem::path& file,
                       const SaveOptions& options) {
  const auto plan = floor_plan(image, options.floor);
  if (!plan) return plan.error();
  const auto picture = write_file_atomically(file, [&](std::ostream& to) { return write_pgm(*plan, to); });
  if (!picture) return picture;
  std::filesystem::path yaml = file;
  yaml.replace_extension(".yaml");
  return write_file_atomically(
      yaml, [&](std::ostream& to) { return write_map_yaml(*plan, file.filename().string(), to); });
}

}  // namespace

Result<void> write_file_atomically(const std::filesystem::path& file,
                                   const std::function<Result<void>(std::ostream&)>& write) {
  std::ostringstream content;
  const Result<void> made = write(content);
  if (!made) return made;
  std::filesystem::path part = file;
  part += ".part";
  int error = write_synced(part, std::move(content).str());
  if (error == 0 && std::rename(part.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) {
    sync_folder_of(file);
    return {};
  }
  ::unlink(part.c_str());
  return write_failed(file, error);
}

Result<void> write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  return write_file_atomically(file, [&](std::ostream& to) {
    to.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return Result<void>();
  });
}

Result<void> save_map(const VoxelImage& image, const std::filesystem::path& file,
                      const SaveOptions& options) {
  using Writer = Result<void> (*)(const VoxelImage&, std::ostream&);
  static constexpr std::array<std::pair<const char*, Writer>, 4> kWriters{
      {{".bt", write_bt}, {".ot", write_ot}, {".pcd", write_pcd}, {".ply", write_ply}}};
  const std::string extension = file.extension().string();
  if (extension == ".pgm") return save_plan(image, file, options);
  for (const auto& [known, writer] : kWriters)
    if (extension == known)
      return write_file_atomically(file, [&, write = writer](std::ostream& to) { return write(image, to); });
  return {Reason::bad_argument,
          file.string() + ": expected a name that ends in .bt, .ot, .pcd, .ply or .pgm"};
}

Result<VoxelImage> load_map(const std::filesystem::path& file) {
  std::error_code failure;
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (failure) return {Reason::cannot_read, file.string() + ": " + failure.message()};
  if (size > kMaxFile) return {Reason::not_supported, file.string() + ": the file is too large"};
  std::ifstream from(file, std::ios::binary);
  std::string content(static_cast<std::size_t>(size), '\0');
  from.read(content.data(), static_cast<std::streamsize>(size));
  if (!from || static_cast<std::uintmax_t>(from.gcount()) != size)
    return {Reason::cannot_read, file.string() + ": cannot be read"};
  Result<VoxelImage> map = read_octree(content);
  if (!map) return {map.error().reason, file.string() + ": " + map.error().text};
  return map;
}

}  // namespace adit::perception

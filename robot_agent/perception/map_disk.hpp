// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/store/disk.hpp"
#include "perception/stream/stored_map.hpp"

namespace adit::agent {

struct MapDiskParams {
  std::string robot{};
  std::size_t max_bytes{std::size_t{8}
                        << 20};  ///< Of all files of the map, beyond which is_full(), [1 MiB, 1 GiB].
  std::size_t min_free{std::size_t{1} << 20};  ///< Space that is left to the robot's state, bytes.
  Duration write{5ms};                         ///< Duration of a write in rehearsal, [0, 1 s].
  Duration retry{5s};                          ///< Pause after a failed write.
};

/// The result of reading the map from the disk. Files that cannot be used are renamed, never deleted.
struct LoadedMap {
  std::vector<perception::StoredSubmap> submaps{};      ///< The oldest first.
  std::vector<perception::StoredPlaces::Peer> peers{};  ///< `has`: positions in `submaps`.
  bool places{};                                        ///< Whether all poses are of one moment.
  std::size_t damaged{}, other_version{}, foreign{}, unreadable{};
  Reason reason{Reason::none};  ///< Of the first file that cannot be used.
  /// What is lost, for operators; empty: nothing.
  std::string text() const;
};

/// The files of a robot's map in its state folder: one for each submap, written when the submap is closed and
/// now and then before, and one with the poses of all. One write at a time, on the disk's strand; of a file
/// that waits to be written, only the newest state is written. A file appears under its name when it is
/// complete. While the disk fails, files wait and the rest goes on. Runs on the command strand.
class MapDisk {
 public:
  /// Reports that the disk began to fail (with the reason), or stores the map again.
  using Failing = std::function<void(bool failing, const std::string& text)>;

  /// `writer`: strand on which a slow disk is written; null: there is none.
  MapDisk(MapDiskParams params, std::shared_ptr<store::Disk> disk, Executor& command,
          std::shared_ptr<Executor> writer, Failing failing);
  ~MapDisk();
  MapDisk(const MapDisk&) = delete;
  MapDisk& operator=(const MapDisk&) = delete;

  /// Reads all files. Call it once, before the first write.
  LoadedMap load();
  void save(perception::StoredSubmap submap);
  void save(perception::StoredPlaces places);
  void remove(const perception::SubmapKey& key);
  /// Whether the map takes more space than it may.
  bool is_full() const;
  /// Bytes of all files of the map.
  std::size_t bytes() const;
  bool failing() const;
  /// Hands queued files to the writer's strand, at a clean end after the command strand has ended.
  void flush();
  /// Retries. Call it at 1 Hz or more.
  void tick();

  static std::string file_name(const perception::SubmapKey& key);
  static constexpr const char* kPlacesFile = "map-places";

 private:
  struct Writer;
  std::shared_ptr<Writer> writer_;
};

}  // namespace adit::agent

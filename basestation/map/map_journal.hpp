// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/store/disk.hpp"

namespace adit::station {

/// Content of one piece of a robot's map, as it came.
struct JournalPiece {
  std::string robot{};
  std::uint8_t kind{};  ///< Value of transfer::Kind.
  store::Bytes data{};
};

struct MapJournalParams {
  std::size_t max_bytes{std::size_t{16} << 20};   ///< Of the file; see MapJournal.
  std::size_t max_waiting{std::size_t{1} << 20};  ///< Of pieces that wait for the disk.
  Duration period{100ms};                         ///< Between two writes.
  Duration write{3ms};                            ///< Duration of a write in rehearsal.
  Duration retry{5s};  ///< Between two attempts to remove a file that is of no use.
};

/// The content of a journal's file.
struct LoadedJournal {
  std::uint32_t start{};  ///< The start under which all of it was acknowledged; 0: it is not complete.
  std::vector<JournalPiece> pieces{};  ///< In the order of their arrival.
  std::size_t bytes{};                 ///< Of the file.
  bool unfinished{false};              ///< The last write was cut off before anything of it was acknowledged.
  std::string lost{};                  ///< What is damaged; empty: nothing.
};

/// The pieces of robots' maps that this station acknowledged, on its disk: after a restart it has them, and
/// continues with the same start (transfer::Ack), so that no robot sends them again.
///
/// A piece is to be acknowledged once it is written. A file that would become too long is written again from
/// the present map, in parallel to the home strand. Where writing is impossible (the disk is full, or the
/// file stays longer than half of its limit), the file is removed and pieces stay in memory from then on:
/// then the next start of the station is a new one, and robots send all again. While the file can be neither
/// written nor removed, no piece is stored.
class MapJournal {
 public:
  /// Packs a copy of the map, on any thread.
  using PackMap = std::function<std::vector<JournalPiece>()>;

  /// `disk` null: in memory only. `trouble`: the map is in memory only from now on, and why. `copy_map`:
  /// copies the map with all pieces that were added, on the home strand; empty: a file is not written again.
  MapJournal(MapJournalParams params, std::shared_ptr<store::Disk> disk, Executor& home,
             std::function<void(const std::string& text)> trouble, std::function<PackMap()> copy_map = {});
  ~MapJournal();
  MapJournal(const MapJournal&) = delete;
  MapJournal& operator=(const MapJournal&) = delete;

  /// Reads the file; one that is damaged is copied aside. Call begin() after it, or resume() if the file is
  /// complete.
  LoadedJournal load();
  /// Begins a new file with these pieces; pieces that wait for the disk are dropped.
  void begin(std::uint32_t start, const std::vector<JournalPiece>& pieces);
  /// Copies the file aside, before it is replaced; returns the copy's name, empty if there is none.
  std::string copy_aside();
  /// Continues the file that load() read, of which nothing is lost or unfinished.
  void resume(std::uint32_t start, std::size_t bytes) {
    start_ = start;
    bytes_ = bytes;
  }
  /// Adds a piece; calls `stored` when it is written, or the map is in memory only. One for which there is no
  /// room is dropped, and comes again.
  void add(JournalPiece piece, std::function<void()> stored);
  /// The next start of the station is a new one, as something will be acknowledged that is not here. Calls
  /// `stored` when that is written, or the map is in memory only; not while it is being written: then what is
  /// to be acknowledged comes again.
  void end_start(std::function<void()> stored);
  /// Forgets what was added of a robot so far; the next start of the station is a new one.
  void forget(const std::string& robot);

  static constexpr const char* kFile = "map-pieces";

 private:
  struct Waiting {
    JournalPiece piece{};
    std::function<void()> stored{};
  };
  /// Whether the file says that its start has ended.
  enum class Ended { no, waiting, written };
  struct Batch;
  void replace();
  void schedule(Duration delay);
  void write();
  void write_again();
  void start(const std::shared_ptr<Batch>& batch);
  void written(const Batch& batch);
  static void report_stored(const std::vector<Waiting>& pieces);

  MapJournalParams params_;
  std::shared_ptr<store::Disk> disk_;  ///< Null: in memory only.
  Executor& home_;
  std::function<void(const std::string&)> trouble_;
  std::function<PackMap()> copy_map_;
  std::uint32_t start_{};
  Ended ended_{Ended::no};
  std::vector<Waiting> waiting_{};
  std::size_t waiting_bytes_{}, bytes_{};
  std::string useless_{};  ///< Why the file must be removed; empty: it must not.
  bool writing_{false};
  bool stuck_{false};  ///< It was reported that the file can be neither written nor removed.
  std::optional<store::Bytes> begin_{};  ///< The new file, while the old one is being written.
  Timer timer_{};
  std::shared_ptr<MapJournal*> self_;
};

}  // namespace adit::station

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/store/disk.hpp"
#include "core/transfer/piece.hpp"

namespace adit::agent {

/// The table of stations that have this robot's findings on their disks, and in which revision. A station is
/// known by its identity, which outlives its process. Stored in the file `findings-known` (version 2; version
/// 1 is read, its revisions are 0): if a write is lost, its findings are only sent once more, which harms no
/// station.
class KnownFindings {
 public:
  static constexpr std::size_t kStations = 16;  ///< Stored for each finding; then the oldest is forgotten.

  /// `disk` null: in memory only. `writer`: as of findings::FindingStore.
  KnownFindings(std::shared_ptr<store::Disk> disk, Executor& home, std::shared_ptr<Executor> writer)
      : disk_(std::move(disk)), home_(home), writer_(std::move(writer)) {}

  /// Reads the file. `exists`: whether the robot still has a finding.
  void load(const std::function<bool(std::uint64_t id)>& exists);
  /// Records that a station has a finding in that revision or a newer one.
  void add(std::uint64_t id, std::uint32_t revision, const transfer::PeerId& station);
  void erase(std::uint64_t id) { stations_.erase(id); }
  /// The revision that a station has; nothing: none.
  std::optional<std::uint32_t> revision(std::uint64_t id, const transfer::PeerId& station) const;
  /// Whether any station has the finding in that revision or a newer one.
  bool has(std::uint64_t id, std::uint32_t revision) const;
  /// Higher than each revision of findings that the robot does not store any more, but a station may.
  std::uint32_t floor() const { return floor_; }
  /// Raises the floor above a revision. A new floor is written at once: call it before the finding is
  /// dropped, so that the writer's strand writes the floor before it removes the file.
  void raise_above(std::uint32_t revision);
  /// Writes the file when it is due.
  void tick(Time now);

 private:
  void save();

  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  using Holder = std::pair<transfer::PeerId, std::uint32_t>;  ///< A station and its revision.
  std::map<std::uint64_t, std::vector<Holder>> stations_{};   ///< By id; never an empty list.
  std::uint32_t floor_{};
  bool changed_{};
  Time saved_{};
  Timer timer_{};
};

}  // namespace adit::agent

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/store/disk.hpp"
#include "core/transfer/piece.hpp"

namespace adit::agent {

/// The table of stations that have this robot's findings on their disks. A station is known by its identity,
/// which outlives its process. Stored in the file `findings-known`: if a write is lost, its findings are only
/// sent once more, which harms no station.
class KnownFindings {
 public:
  static constexpr std::size_t kStations = 16;  ///< Stored for each finding; then the oldest is forgotten.

  /// `disk` null: in memory only. `writer`: as of findings::FindingStore.
  KnownFindings(std::shared_ptr<store::Disk> disk, Executor& home, std::shared_ptr<Executor> writer)
      : disk_(std::move(disk)), home_(home), writer_(std::move(writer)) {}

  /// Reads the file. `exists`: whether the robot still has a finding.
  void load(const std::function<bool(std::uint64_t id)>& exists);
  void add(std::uint64_t id, const transfer::PeerId& station);
  void erase(std::uint64_t id) { stations_.erase(id); }
  bool has(std::uint64_t id, const transfer::PeerId& station) const;
  /// Whether any station has it.
  bool has(std::uint64_t id) const { return stations_.contains(id); }
  /// Writes the file when it is due.
  void tick(Time now);

 private:
  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  std::map<std::uint64_t, std::vector<transfer::PeerId>> stations_{};  ///< By id; never an empty list.
  bool changed_{};
  Time saved_{};
  Timer timer_{};
};

}  // namespace adit::agent

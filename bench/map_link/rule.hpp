// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/map_link/air.hpp"
#include "bench/map_link/recording.hpp"
#include "bench/map_link/watch.hpp"

namespace adit::bench {

/// Where a rule acts. All outlive it.
struct Mission {
  Air& air;
  Watch& watch;
  const std::vector<MapRecording>& robots;
  std::uint64_t seed{1};
};

/// Where the bytes and the time of a rule went, as it knows them itself.
struct Account {
  std::uint64_t content{};  ///< Bytes of the map itself, without headers.
  /// Of them: of places never sent, of blocks that changed since they were sent, of blocks that were lost,
  /// and of voxels of 0.4 m.
  double first{}, changed{}, repeated{}, coarse{};
  std::uint64_t poses{};                   ///< Of them: poses of submaps.
  std::uint64_t lost{}, sent{};            ///< Pieces.
  std::uint64_t held{}, paced{}, ticks{};  ///< Rounds with something to send, but held back or no credit.

  void add(const Account& other);
};

/// A way to send the maps of robots to a station: both sides of it.
class Rule {
 public:
  virtual ~Rule() = default;

  /// A robot's map changed.
  virtual void update(std::size_t robot, const MapUpdate& update) = 0;
  /// Called every 50 ms.
  virtual void tick() = 0;
  /// Whether nothing is left to send.
  virtual bool settled() const = 0;
  virtual Account account() const { return {}; }
  /// Voxels that the station shows otherwise than the robots; 0 for a rule that need not be equal.
  virtual std::size_t different_voxels() const { return 0; }
};

/// Makes a rule for a mission.
using MakeRule = std::function<std::unique_ptr<Rule>(const Mission&)>;

/// This project: transfer::Sender, BlockSource and PoseSource at the robots; MapReceiver at the station.
std::unique_ptr<Rule> make_adit_rule(const Mission& mission);
/// The whole map at 0.2 m as a .bt file, compressed with `zstd -19`, every 10 s. Frames that were lost are
/// asked for each second until all came; then the newest map is sent.
std::unique_ptr<Rule> make_file_rule(const Mission& mission);
/// What MARBLE's robots did (marble_mapping and bobcat): see diff_rule.cpp.
std::unique_ptr<Rule> make_diff_rule(const Mission& mission);

/// Bytes of blocks of a lattice as a .bt file at 0.2 m, compressed with `zstd -19`; 0 without blocks.
std::size_t octree_file_bytes(const std::vector<perception::CoarseBlock>& blocks);

}  // namespace adit::bench

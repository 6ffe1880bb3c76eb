// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "basestation/map/map_journal.hpp"
#include "basestation/map/map_receiver.hpp"

namespace adit::station {

/// The robots' maps as this station has them, and on its disk.
class MapReplica {
 public:
  /// `start`: drawn at this start of the station. `trouble`: the map is in memory only from now on.
  MapReplica(std::uint32_t start, std::shared_ptr<store::Disk> disk, Executor& home,
             std::function<void(const std::string& text)> trouble, MapJournalParams journal = {});

  /// Loads the maps on the disk; returns what is lost, as text. Call it before anything else.
  std::string load();
  /// The start of this station as robots should know it (transfer::Ack): the one before if nothing is missing
  /// of what was acknowledged then.
  std::uint32_t start() const { return start_; }
  /// Takes one piece, see MapReceiver::take and take_carried. `stored` is called when it should be
  /// acknowledged.
  Result<void> take(const std::string& robot, std::uint8_t kind, std::uint32_t waiting,
                    std::span<const std::uint8_t> data, std::function<void()> stored);
  /// Forgets all maps. Robots that are heard send theirs again, to the start that is given.
  void forget(std::uint32_t start);

  const ChunkStore& chunks() const { return receiver_.chunks(); }
  const MapReceiver& receiver() const { return receiver_; }

 private:
  void forget_evicted();
  Result<void> take_carried(const std::string& carrier, std::uint8_t kind, std::uint32_t waiting,
                            std::span<const std::uint8_t> data, std::function<void()> stored);

  Executor& home_;
  std::uint32_t start_;
  MapReceiver receiver_{};
  std::set<std::string> written_{};  ///< Robots with pieces in the journal.
  std::uint64_t evicted_{};          ///< ChunkStore::evicted(), as far as the journal has it.
  MapJournal journal_;
};

/// All that is stored, as few pieces as possible.
std::vector<JournalPiece> pieces_of(const ChunkStore& chunks);

}  // namespace adit::station

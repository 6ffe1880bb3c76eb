// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "basestation/map/chunk_store.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// Takes pieces of robots' maps as they come by radio, genuine or not, into the replica.
class MapReceiver {
 public:
  /// Takes one piece. `robot`: a robot whose participant sent it. Errors: malformed (also: content of another
  /// robot), out_of_range (changes of blocks that are not here in that state), not_supported (a kind of a
  /// later release), queue_full (no room). What does not fit, or will never be understood, should be
  /// acknowledged, too: it would come again without end. A piece that is damaged or whose base is missing
  /// should not, as its content comes in another one.
  Result<void> take(const std::string& robot, std::uint8_t kind, std::uint32_t waiting,
                    std::span<const std::uint8_t> data, Time now);

  /// Takes a piece of another robot's map than the sender's (transfer::is_carried). Returns whether anything
  /// of it was newer. Errors as take(); malformed also for a map of the sender.
  Result<bool> take_carried(const std::string& carrier, std::uint8_t kind, std::uint32_t waiting,
                            std::span<const std::uint8_t> data, std::optional<Time> now);

  /// Takes a piece of the disk, from before this start of the station. Errors as take().
  Result<void> restore(const std::string& robot, std::uint8_t kind, std::span<const std::uint8_t> data);

  void forget() { chunks_.clear(); }

  const ChunkStore& chunks() const { return chunks_; }
  /// Number of pieces that could not be taken.
  std::uint64_t refused() const { return refused_; }

 private:
  Result<void> store(const std::string& robot, std::uint8_t kind, std::span<const std::uint8_t> data);

  ChunkStore chunks_{};
  std::uint64_t refused_{};
};

}  // namespace adit::station

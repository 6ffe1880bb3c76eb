// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "basestation/map/chunk_store.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// Takes pieces of robots' maps as they come by radio, genuine or not, into the replica.
class MapReceiver {
 public:
  /// Takes one piece. `robot`: a robot whose participant sent it. Errors: malformed (also: content of another
  /// robot), out_of_range (changes of blocks that are not here in that state), not_supported (a kind of a
  /// later release), queue_full (no room). Some should be acknowledged, see transfer::is_acknowledged.
  Result<void> take(const std::string& robot, std::uint8_t kind, std::uint32_t waiting,
                    std::span<const std::uint8_t> data, Time now);

  struct Carried {
    Result<void> taken{};
    std::vector<std::uint8_t>
        newer{};  ///< What was stored of it, as a piece, also when the rest was refused.
  };
  /// Takes a piece of another robot's map than the sender's (transfer::is_carried). Errors as take();
  /// malformed also for a map of the sender, out_of_range for any changes.
  Carried take_carried(const std::string& carrier, std::uint8_t kind, std::uint32_t waiting,
                       std::span<const std::uint8_t> data, std::optional<Time> now);

  /// Takes a piece of the disk, from before this start of the station. Errors as take().
  Result<void> restore(const std::string& robot, std::uint8_t kind, std::span<const std::uint8_t> data);

  void forget() { chunks_.clear(); }

  const ChunkStore& chunks() const { return chunks_; }
  /// Number of pieces that could not be taken.
  std::uint64_t refused() const { return refused_; }

 private:
  Result<void> store(const std::string& robot, std::uint8_t kind, std::span<const std::uint8_t> data);
  Carried store_carried(const std::string& carrier, std::uint8_t kind, std::span<const std::uint8_t> data,
                        std::optional<Time> now);

  ChunkStore chunks_{};
  std::uint64_t refused_{};
};

}  // namespace adit::station

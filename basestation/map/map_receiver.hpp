// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "basestation/map/chunk_store.hpp"
#include "core/result/result.hpp"
#include "core/transfer/receiver.hpp"

namespace adit::station {

/// Takes pieces of robots' maps as they come by radio, genuine or not, into the replica. A piece is
/// acknowledged once its content is stored.
class MapReceiver {
 public:
  /// Takes one piece. `robot`: a robot whose participant sent it. Errors: malformed (also: content of another
  /// robot), not_supported (a kind of a later release), queue_full (no room).
  Result<void> take(const std::string& robot, std::uint32_t session, std::uint32_t id, std::uint8_t kind,
                    std::uint32_t waiting, std::span<const std::uint8_t> data, Time now);
  /// Receipts to send now, by robot; see transfer::Receiver::due.
  std::optional<std::vector<std::pair<std::string, transfer::Receipt>>> due(Time now, double bandwidth) {
    return receiver_.due(now, bandwidth);
  }
  void greet() { receiver_.greet(); }

  const ChunkStore& chunks() const { return chunks_; }
  /// Number of pieces that could not be taken.
  std::uint64_t refused() const { return refused_; }

 private:
  Result<void> store(const std::string& robot, std::uint8_t kind, std::span<const std::uint8_t> data);

  ChunkStore chunks_{};
  transfer::Receiver receiver_{};
  std::uint64_t refused_{};
};

}  // namespace adit::station

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result/reason.hpp"

namespace adit::transfer {

/// Kind of content; the values travel on the wire.
enum class Kind : std::uint8_t {
  map_blocks = 1,
  map_poses = 2,
  findings = 3,
  carried_blocks = 4,  ///< Of another robot's map than the sender's.
  carried_poses = 5,
  photos = 6,
  shots = 7,  ///< Single pictures of cameras, for the station that asked.
};

constexpr bool is_carried(std::uint8_t kind) {
  return kind == static_cast<std::uint8_t>(Kind::carried_blocks) ||
         kind == static_cast<std::uint8_t>(Kind::carried_poses);
}

/// 128 random bits: of a station, stored on its disk; of a carrier, drawn at each start.
using PeerId = std::array<std::uint8_t, 16>;

inline constexpr std::size_t kMaxPieceBytes = 1200;  ///< Largest content of a piece, bytes.
/// Bytes of a piece beside its content: headers of the message and of the network.
inline constexpr std::size_t kPieceOverhead = 144;

/// One message with content that is usable alone.
struct Piece {
  Kind kind{};
  std::uint32_t id{};  ///< From 1, rises with each piece of a session.
  std::uint32_t
      waiting{};  ///< Parts of all kinds that the peer that lacks most still lacks, beside this piece.
  std::vector<std::uint8_t> data{};
  bool for_carriers{false};  ///< For robots that carry it on to stations; else for the stations.
};

/// Whether a piece that was refused for this reason is acknowledged: what does not fit, or will never be
/// understood, would come again without end. A piece that is damaged, or whose base is missing, is not: its
/// content comes in another one.
constexpr bool is_acknowledged(Reason refused_for) {
  return refused_for != Reason::malformed && refused_for != Reason::out_of_range;
}

/// The pieces of one session of a sender that arrived at a peer.
struct Receipt {
  static constexpr std::uint32_t kSpan = 128;  ///< Number of pieces that it covers, back from `newest`.
  std::uint32_t session{};
  std::uint32_t newest{};                   ///< Largest id that arrived; 0: none.
  std::array<std::uint64_t, 2> received{};  ///< Bit i of word w: piece newest - 64 w - i arrived.

  bool has(std::uint32_t id) const {
    if (id == 0 || id > newest || newest - id >= kSpan) return false;
    const std::uint32_t back = newest - id;
    return (received[back / 64] >> (back % 64) & 1) != 0;
  }
  bool operator==(const Receipt&) const = default;
};

/// A place that matters most to a peer, map frame, m.
struct Look {
  static constexpr float kMaxRadius = 100.0F;
  float x{}, y{};
  float radius{};  ///< (0, kMaxRadius].
  bool operator==(const Look&) const = default;
};

/// Digest of one robot's map as a station has it: equal parts have equal sums (perception::MapDigest).
struct ContentDigest {
  static constexpr std::size_t kParts = 33;
  std::string robot{};
  std::array<std::uint32_t, kParts> parts{};
  bool operator==(const ContentDigest&) const = default;
};

/// A peer's acknowledgement of one sender's pieces.
struct Ack {
  PeerId peer{};
  std::uint32_t start{};  ///< Of what the peer has: another one begins with nothing.
  Receipt receipt{};      ///< Of a session 0: the peer has no piece of this sender.
  std::optional<Look> look{};
  bool carrier{false};                   ///< Of a robot that carries what it receives on to stations.
  std::vector<std::string> senders{};    ///< Robots whose own pieces the peer received lately.
  std::vector<ContentDigest> digests{};  ///< Of maps that the peer has.
  bool all_digests{false};               ///< The peer has no other maps than those of `digests`.
};

}  // namespace adit::transfer

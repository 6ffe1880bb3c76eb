// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/findings/photo_file.hpp"
#include "core/result/result.hpp"

namespace adit::findings {

/// Some blocks of a photo on their way to stations. The message that carries it names the sender.
struct PhotoPiece {
  static constexpr std::size_t kMaxBytes = 1000;  ///< Largest encoded piece that is read.
  static constexpr std::size_t kHead = 20;        ///< Bytes of an encoded piece beside its blocks.
  static constexpr std::size_t kMaxBlocks = (kMaxBytes - kHead) / kPhotoBlock;

  PhotoPart part{};
  std::uint64_t content{};  ///< As in PhotoRef.
  std::uint32_t bytes{};    ///< Of the whole part.
  std::uint16_t first{};    ///< Its first block.
  store::Bytes data{};      ///< One to kMaxBlocks blocks.
  bool operator==(const PhotoPiece&) const = default;
};

/// Encodes a piece: version, part, content, bytes, first, data, and a checksum (CRC-32C).
store::Bytes encode(const PhotoPiece& piece);
/// Decodes a piece, from anyone. Reason::wrong_protocol for another version, malformed for everything else
/// that is wrong: truncated, damaged, too long, blocks that are not whole or lie outside the part.
Result<PhotoPiece> decode_photo_piece(std::span<const std::uint8_t> bytes);

}  // namespace adit::findings

// SPDX-License-Identifier: Apache-2.0
#include "core/findings/photo_piece.hpp"

#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"

namespace adit::findings {
namespace {

constexpr std::uint8_t kPieceVersion = 1;
constexpr std::size_t kSum = 4;

Error no_photo_piece(const char* what) {
  return {Reason::malformed, std::string("a piece of a photo: ") + what};
}

}  // namespace

store::Bytes encode(const PhotoPiece& piece) {
  store::Packer out;
  out.put(kPieceVersion).put(static_cast<std::uint8_t>(piece.part)).put(piece.content).put(piece.bytes);
  out.put(piece.first).raw(piece.data);
  const std::uint32_t sum = crc32c(out.bytes());
  return out.put(sum).bytes();
}

Result<PhotoPiece> decode_photo_piece(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > PhotoPiece::kMaxBytes) return no_photo_piece("empty, or too long");
  if (bytes[0] != kPieceVersion) return {Reason::wrong_protocol, "a piece of a photo has another version"};
  if (bytes.size() <= PhotoPiece::kHead) return no_photo_piece("too short");
  const auto content = bytes.first(bytes.size() - kSum);
  if (store::Unpacker(bytes.last(kSum)).get<std::uint32_t>() != crc32c(content))
    return no_photo_piece("damaged");
  store::Unpacker in(content.subspan(1));
  const auto part = in.get<std::uint8_t>();
  PhotoPiece piece;
  piece.part = static_cast<PhotoPart>(part);
  piece.content = in.get<std::uint64_t>();
  piece.bytes = in.get<std::uint32_t>();
  piece.first = in.get<std::uint16_t>();
  piece.data.assign(in.rest().begin(), in.rest().end());
  if (part > static_cast<std::uint8_t>(PhotoPart::picture) || piece.content == 0)
    return no_photo_piece("it is of no photo");
  const std::size_t most =
      piece.part == PhotoPart::picture ? PhotoRef::kMaxBytes : std::size_t{PhotoRef::kMaxThumbnail};
  if (piece.bytes == 0 || piece.bytes > most) return no_photo_piece("its photo is too large");
  const std::size_t begin = piece.first * kPhotoBlock, end = begin + piece.data.size();
  const bool whole = piece.data.size() % kPhotoBlock == 0 || end == piece.bytes;
  if (begin >= piece.bytes || end > piece.bytes || !whole)
    return no_photo_piece("blocks outside of its photo");
  return piece;
}

}  // namespace adit::findings

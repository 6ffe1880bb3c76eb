// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/shot_piece.hpp"

#include <bit>
#include <cmath>

#include "core/command/words.hpp"
#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"
#include "core/transfer/piece.hpp"

namespace adit::transfer {
namespace {

constexpr std::uint8_t kShotVersion = 1;
constexpr std::size_t kShotSum = 4;
constexpr std::size_t kMaxCameraName = 32;
constexpr float kFarthestShot = 1e5F;  // m

Error no_shot_piece(const char* what) {
  return {Reason::malformed, std::string("a piece of a picture: ") + what};
}

bool is_place(const std::array<float, 4>& place) {
  for (const float each : place)
    if (!std::isfinite(each) || std::abs(each) > kFarthestShot) return false;
  return true;
}

}  // namespace

std::vector<std::uint8_t> encode(const ShotPiece& piece) {
  store::Packer out;
  out.put(kShotVersion).text<std::uint8_t>(piece.camera);
  out.put(piece.number).put(piece.stamp).put(piece.age).put(piece.bytes).put(piece.crc).put(piece.first);
  out.flag(piece.place.has_value());
  if (piece.place)
    for (const float each : *piece.place) out.put(std::bit_cast<std::uint32_t>(each));
  out.raw(piece.data);
  const std::uint32_t sum = crc32c(out.bytes());
  return out.put(sum).bytes();
}

Result<ShotPiece> decode_shot_piece(std::span<const std::uint8_t> bytes) {
  if (bytes.size() <= ShotPiece{}.head() || bytes.size() > kMaxPieceBytes)
    return no_shot_piece("too short, or too long");
  if (bytes[0] != kShotVersion) return {Reason::wrong_protocol, "a piece of a picture has another version"};
  const auto content = bytes.first(bytes.size() - kShotSum);
  if (store::Unpacker(bytes.last(kShotSum)).get<std::uint32_t>() != crc32c(content))
    return no_shot_piece("damaged");
  store::Unpacker in(content.subspan(1));
  ShotPiece piece;
  piece.camera = in.text<std::uint8_t>(kMaxCameraName);
  piece.number = in.get<std::uint32_t>();
  piece.stamp = in.get<std::uint64_t>();
  piece.age = in.get<std::uint32_t>();
  piece.bytes = in.get<std::uint32_t>();
  piece.crc = in.get<std::uint32_t>();
  piece.first = in.get<std::uint16_t>();
  if (in.flag()) {
    std::array<float, 4>& place = piece.place.emplace();
    for (float& each : place) each = std::bit_cast<float>(in.get<std::uint32_t>());
    if (!is_place(place)) return no_shot_piece("its place is none");
  }
  if (!in.good() || piece.number == 0 || !command::valid_name(piece.camera))
    return no_shot_piece("a field has no meaning");
  piece.data.assign(in.rest().begin(), in.rest().end());
  if (piece.bytes == 0 || piece.bytes > ShotPiece::kMaxPicture)
    return no_shot_piece("its picture is too large");
  const std::size_t begin = piece.first * kShotBlock, end = begin + piece.data.size();
  const bool whole = piece.data.size() % kShotBlock == 0 || end == piece.bytes;
  if (piece.data.empty() || end > piece.bytes || !whole)
    return no_shot_piece("blocks outside of its picture");
  return piece;
}

}  // namespace adit::transfer

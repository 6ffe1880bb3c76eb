// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/piece.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"

namespace adit::perception {
namespace {

constexpr std::uint8_t kPictureVersion = 1;
constexpr std::uint8_t kColourFlag = 1, kPoseFlag = 2;
constexpr std::size_t kPieceSum = 4;  // Bytes of the checksum.

Error no_picture_piece(const char* what) {
  return {Reason::malformed, std::string("a piece of a picture: ") + what};
}

void put_float(store::Packer& to, float value) { to.put(std::bit_cast<std::uint32_t>(value)); }
float get_float(store::Unpacker& from) { return std::bit_cast<float>(from.get<std::uint32_t>()); }

bool is_pose(const CameraPose& pose) {
  double norm = 0.0;
  for (const float part : pose.orientation) norm += double{part} * double{part};
  return std::ranges::all_of(pose.position, [](float part) { return std::isfinite(part); }) &&
         std::abs(norm - 1.0) < 1e-2;  // Not so of a part that is not finite.
}

/// A marker inside of a stripe would end it, and spoil those behind it.
bool has_marker(std::span<const std::uint8_t> data) {
  for (std::size_t i = 0; i < data.size(); ++i)
    if (data[i] == 0xff && (i + 1 == data.size() || data[i + 1] != 0)) return true;
  return false;
}

PictureHeader read_picture_header(store::Unpacker& in, std::uint8_t flags) {
  PictureHeader header;
  header.run = in.get<std::uint32_t>();
  header.frame = in.get<std::uint32_t>();
  header.format.colour = (flags & kColourFlag) != 0;
  header.format.width = in.get<std::uint16_t>();
  header.format.height = in.get<std::uint16_t>();
  header.format.quality = in.get<std::uint8_t>();
  header.format.span = in.get<std::uint8_t>();
  header.stamp = in.get<std::uint64_t>();
  header.age = in.get<std::uint16_t>();
  header.digest = in.get<std::uint32_t>();
  header.pieces = in.get<std::uint8_t>();
  header.number = in.get<std::uint8_t>();
  if ((flags & kPoseFlag) == 0) return header;
  header.pose.emplace();
  for (float& part : header.pose->position) part = get_float(in);
  for (float& part : header.pose->orientation) part = get_float(in);
  return header;
}

}  // namespace

bool PictureFormat::is_valid() const {
  return width > 0 && height > 0 && width <= kMaxWidth && height <= kMaxHeight && quality >= 1 &&
         quality <= 100 && span >= 1 && span <= row() && stripes() <= kMaxStripes;
}

std::uint32_t stripe_digest(std::uint16_t index, std::span<const std::uint8_t> data) {
  // Multiplied, so that two stripes with the same difference do not cancel out.
  return (crc32c(data, index) | 1U) * (index * 0x9e3779b9U | 1U);
}

std::vector<std::uint8_t> encode(const PicturePiece& piece) {
  const PictureHeader& header = piece.header;
  store::Packer out;
  out.put(kPictureVersion);
  out.put(
      static_cast<std::uint8_t>((header.format.colour ? kColourFlag : 0) | (header.pose ? kPoseFlag : 0)));
  out.put(header.run).put(header.frame).put(header.format.width).put(header.format.height);
  out.put(header.format.quality).put(header.format.span).put(header.stamp).put(header.age).put(header.digest);
  out.put(header.pieces).put(header.number);
  if (header.pose) {
    for (const float part : header.pose->position) put_float(out, part);
    for (const float part : header.pose->orientation) put_float(out, part);
  }
  std::uint32_t next = 0;
  for (const Stripe& stripe : piece.stripes) {
    out.varint(stripe.index - next).varint(stripe.data.size()).raw(stripe.data);
    next = stripe.index + 1U;
  }
  const std::uint32_t sum = crc32c(out.bytes());
  return out.put(sum).bytes();
}

Result<PicturePiece> decode_picture_piece(std::span<const std::uint8_t> bytes) {
  if (bytes.size() <= kPieceSum || bytes.size() > kMaxPicturePiece)
    return no_picture_piece("too short, or too long");
  const auto content = bytes.first(bytes.size() - kPieceSum);
  if (store::Unpacker(bytes.last(kPieceSum)).get<std::uint32_t>() != crc32c(content))
    return no_picture_piece("damaged");
  store::Unpacker in(content);
  if (in.get<std::uint8_t>() != kPictureVersion)
    return {Reason::not_supported, "a piece of a picture has another version"};
  const auto flags = in.get<std::uint8_t>();
  if (flags > (kColourFlag | kPoseFlag)) return no_picture_piece("its flags");
  PicturePiece piece;
  piece.header = read_picture_header(in, flags);
  const PictureHeader& header = piece.header;
  if (!in.good()) return no_picture_piece("its length");
  if (header.run == 0 || header.frame == 0 || header.number >= header.pieces)
    return no_picture_piece("its numbers");
  if (!header.format.is_valid()) return no_picture_piece("its format");
  if (header.pose && !is_pose(*header.pose)) return no_picture_piece("its pose");
  std::uint64_t next = 0;
  while (in.good() && !in.rest().empty()) {
    const std::uint64_t gap = in.varint(), size = in.varint();
    if (!in.good() || gap >= header.format.stripes() || next + gap >= header.format.stripes())
      return no_picture_piece("the number of a stripe");
    if (size == 0 || size > in.rest().size()) return no_picture_piece("the length of a stripe");
    const auto data = in.rest().first(static_cast<std::size_t>(size));
    in = store::Unpacker(in.rest().subspan(data.size()));
    if (has_marker(data)) return no_picture_piece("a marker in a stripe");
    piece.stripes.push_back({static_cast<std::uint16_t>(next + gap), {data.begin(), data.end()}});
    next += gap + 1;
  }
  if (!in.done()) return no_picture_piece("its length");
  return piece;
}

}  // namespace adit::perception

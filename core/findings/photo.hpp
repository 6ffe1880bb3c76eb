// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "core/findings/finding.hpp"
#include "core/result/result.hpp"

namespace adit::findings {

/// A photo of a finding: a JPEG that was decoded without a warning, and its thumbnail.
struct Photo {
  static constexpr std::size_t kMaxBytes = PhotoRef::kMaxBytes;  ///< Of the picture.
  static constexpr std::size_t kMaxThumbnail = 2048;             ///< Bytes.
  static constexpr std::size_t kMaxInput = 8 << 20;              ///< Of a JPEG that is decoded at all, bytes.
  static constexpr std::uint32_t kMaxSide = 10'000;              ///< Of the same, pixels.
  static constexpr std::uint64_t kMaxPixels = 40'000'000;        ///< Of the same.
  static constexpr int kMaxScans = 32;                           ///< Of a progressive JPEG; cameras write 10.
  static constexpr std::uint32_t kThumbnailSide = 128;           ///< Longer side of a thumbnail, pixels.
  static constexpr std::uint32_t kSide = 1600;  ///< Longer side of a picture that is recompressed, pixels.

  store::Bytes picture{};    ///< JPEG, at most kMaxBytes.
  store::Bytes thumbnail{};  ///< JPEG, at most kMaxThumbnail bytes.
  std::uint64_t hash{};      ///< Of the picture's bytes.
};

/// The pixels of a photo.
struct PhotoPixels {
  std::uint32_t width{}, height{};
  std::vector<std::uint8_t> rgb{};  ///< Three bytes each, row by row without a gap.
};

/// The name and sizes of a photo.
inline PhotoRef ref_of(const Photo& photo) {
  return {photo.hash, static_cast<std::uint32_t>(photo.picture.size()),
          static_cast<std::uint16_t>(photo.thumbnail.size())};
}

/// Whether a JPEG of so many bytes is read at all. Error: out_of_range.
Result<void> check_photo_size(std::size_t bytes);

/// Checks a JPEG by decoding it, scales and recompresses it where it has more than Photo::kMaxBytes, and
/// makes its thumbnail. Takes up to a second of one processor and 60 MB: run it as compute work.
///
/// Errors: malformed (no JPEG, truncated, damaged, CMYK), out_of_range (beyond the bounds of Photo),
/// cancelled.
Result<Photo> make_photo(std::span<const std::uint8_t> jpeg, const std::stop_token& stop = {});

/// Decodes a JPEG. One whose longer side has more than Photo::kSide pixels is scaled down, to at least that
/// many. Takes as long as make_photo(). Errors: as of make_photo().
Result<PhotoPixels> decode_photo(std::span<const std::uint8_t> jpeg, const std::stop_token& stop = {});

/// Checks the header of a JPEG alone: that it is one, and within the bounds of Photo. It costs little; the
/// rest of the JPEG may be damaged. `most`: for its longer side, pixels. Errors: as of make_photo().
Result<void> check_photo_header(std::span<const std::uint8_t> jpeg, std::uint32_t most = Photo::kMaxSide);

/// Hash of a picture's bytes, FNV-1a; it detects damage, not forgery.
std::uint64_t photo_hash(std::span<const std::uint8_t> bytes);

}  // namespace adit::findings

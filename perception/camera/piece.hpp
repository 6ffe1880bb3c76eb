// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/result/result.hpp"

namespace adit::perception {

/// How the pixels of a picture are coded. A picture is cut into stripes of `span` MCUs in raster order; a
/// stripe may go on in the next row, and the last one may be shorter. An MCU has 8 x 8 pixels when grey, else
/// 16 x 16.
struct PictureFormat {
  static constexpr std::uint16_t kMaxWidth = 1920, kMaxHeight = 1088;
  static constexpr std::size_t kMaxStripes = 512;

  std::uint16_t width{}, height{};  ///< Pixels; need not be multiples of the MCU.
  bool colour{};
  std::uint8_t quality{50};  ///< Of JPEG, [1, 100].
  std::uint8_t span{};       ///< MCUs of a stripe, >= 1, at most those of a row.
  bool operator==(const PictureFormat&) const = default;

  std::uint32_t mcu() const { return colour ? 16 : 8; }
  std::uint32_t row() const { return (width + mcu() - 1) / mcu(); }  ///< MCUs of a row.
  std::uint32_t rows() const { return (height + mcu() - 1) / mcu(); }
  std::uint32_t mcus() const { return row() * rows(); }
  std::uint32_t stripes() const { return span == 0 ? 0 : (mcus() + span - 1) / span; }
  /// Stripe that has a pixel.
  std::uint32_t stripe_at(std::uint32_t x, std::uint32_t y) const {
    return (y / mcu() * row() + x / mcu()) / span;
  }
  /// Within the bounds above.
  bool is_valid() const;
};

/// Where a camera was: position, m, and orientation of its mounting's frame, in the map frame.
struct CameraPose {
  std::array<float, 3> position{};
  std::array<float, 4> orientation{};  ///< Unit quaternion x y z w.
  bool operator==(const CameraPose&) const = default;
};

/// What every piece of a picture says of it.
struct PictureHeader {
  std::uint32_t run{};    ///< Drawn at each start of the sender, not 0; numbers of others are not compared.
  std::uint32_t frame{};  ///< From 1, rises by one with each picture of a run.
  PictureFormat format{};
  std::uint64_t stamp{};   ///< Exposure by the robot's clock, ns.
  std::uint16_t age{};     ///< Time from the exposure to the sending, ms; 65535: that or longer.
  std::uint32_t digest{};  ///< Of all stripes as a receiver has them after this picture; 0: unknown.
  std::uint8_t pieces{1};  ///< Of the picture.
  std::uint8_t number{};   ///< Of this piece, < pieces.
  std::optional<CameraPose> pose{};  ///< Nothing: unknown.
  bool operator==(const PictureHeader&) const = default;
};

/// Entropy-coded data of a stripe, as between two restart markers of a baseline JPEG with the standard
/// tables.
struct Stripe {
  std::uint16_t index{};
  std::vector<std::uint8_t> data{};
  bool operator==(const Stripe&) const = default;
};

/// A piece that decodes alone.
struct PicturePiece {
  PictureHeader header{};
  std::vector<Stripe> stripes{};  ///< By their index, which rises.
  bool operator==(const PicturePiece&) const = default;
};

/// Largest encoded header, bytes, and what a stripe needs beside its data at most.
inline constexpr std::size_t kPictureHeaderBytes = 64;
inline constexpr std::size_t kStripeBytes = 4;
inline constexpr std::size_t kMaxPicturePiece = 1200;  ///< Bytes.

/// What one stripe adds to PictureHeader::digest.
std::uint32_t stripe_digest(std::uint16_t index, std::span<const std::uint8_t> data);

std::vector<std::uint8_t> encode(const PicturePiece& piece);
/// Errors: malformed (truncated, damaged, too long, stripes out of order, empty or with a marker, a format
/// that is not valid, numbers that are not finite), not_supported (of a later version).
Result<PicturePiece> decode_picture_piece(std::span<const std::uint8_t> bytes);

}  // namespace adit::perception

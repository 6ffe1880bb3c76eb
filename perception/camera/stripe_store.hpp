// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "perception/camera/picture.hpp"
#include "perception/camera/piece.hpp"

namespace adit::perception {

/// The newest picture of one camera as its pieces come: which stripes are there, and which are older than the
/// picture because a piece was lost. Decodes nothing. Bounded by PictureFormat.
///
/// The pieces of a picture have its stripes in their order, so a lost one can only have had those between its
/// neighbours' stripes. When a whole picture is lost, all stripes are in doubt until the digest of a later
/// picture shows that none is missing.
class StripeStore {
 public:
  /// Takes a piece; returns false for one that is older than what is here, or that came before. A new run or
  /// format begins a new picture; its missing stripes are absent until they come.
  bool take(const PicturePiece& piece);

  /// Header of the newest picture of which a piece came; nothing: none came.
  const std::optional<PictureHeader>& newest() const { return newest_; }
  /// Whether all pieces of the newest picture came.
  bool is_complete() const;
  /// Pieces of the present run that came, for the report to the sender.
  std::uint32_t arrived() const { return arrived_; }
  /// Bit i of byte b: stripe 8 b + i is absent, or a piece that may have had it was lost since it came.
  /// Empty: all are there. Pieces of the newest picture after the last one that came count as lost unless
  /// `late_too` is false: they may still be on their way, and need not be asked for.
  std::vector<std::uint8_t> missing(bool late_too = true) const;
  /// Bits as of missing(): stripes that never came in the present format. Empty: none.
  std::vector<std::uint8_t> absent() const;
  /// One JPEG of all stripes that are here, whole: those that are absent are grey. Empty before the first
  /// piece.
  std::vector<std::uint8_t> as_jpeg() const;

 private:
  struct Held {
    std::vector<std::uint8_t> data{};  ///< Empty: absent.
    std::uint32_t digest{};
    bool doubtful{};  ///< A later piece that may have had it was lost.
  };
  /// A piece of the newest picture.
  struct Seen {
    bool here{};
    std::int32_t first{-1}, last{-1};  ///< Its stripes; -1: it has none.
  };
  void begin_picture(const PictureHeader& header);
  void mark_gaps(std::vector<bool>& marked, bool late_too) const;

  std::optional<PictureHeader> newest_{};
  std::vector<Held> stripes_{};
  std::vector<Seen> pieces_{};
  std::uint32_t arrived_{};
};

/// A whole JPEG of stripes in a format: `stripes[i]` empty or null is replaced by grey. For programs that
/// show it. Empty when the format is not valid. Decode it with decode_jpeg_tolerant() when stripes came over
/// a network.
std::vector<std::uint8_t> jpeg_of(const PictureFormat& format,
                                  const std::vector<const std::vector<std::uint8_t>*>& stripes);

/// Greys the stripes of a decoded picture that are marked: their colour goes, and they are darker, so that an
/// operator sees that they are not of now. Where `former` (of any size; may be empty) is given, absent
/// stripes show its pixels: give the last picture before its own marks. `marked`, `absent`: bits as of
/// StripeStore::missing(). The picture may have been scaled when it was decoded.
void mark_missing(Picture& picture, const PictureFormat& format, std::span<const std::uint8_t> marked,
                  std::span<const std::uint8_t> absent, const Picture& former);

}  // namespace adit::perception

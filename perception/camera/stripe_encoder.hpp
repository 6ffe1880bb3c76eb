// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/time/time.hpp"
#include "perception/camera/picture.hpp"
#include "perception/camera/piece.hpp"

namespace adit::perception {

/// Parameters of StripeEncoder.
struct StripeParams {
  double change{4.0};     ///< Mean difference of an 8 x 8 block above which its stripe has changed, of 255.
  Duration refresh{10s};  ///< Stripes that do not change are sent again after this time.
};

/// Codes the pictures of one camera in stripes, and leaves out those that did not change since they were
/// sent.
class StripeEncoder {
 public:
  explicit StripeEncoder(StripeParams params = {});
  ~StripeEncoder();
  StripeEncoder(StripeEncoder&&) noexcept;
  StripeEncoder& operator=(StripeEncoder&&) noexcept;

  struct Coded {
    PictureFormat format{};
    std::vector<Stripe> stripes{};
    std::uint32_t digest{};  ///< For PictureHeader::digest.
    bool whole{};            ///< All stripes are here.
  };
  /// Codes a picture of the format's size (`picture.channels` may differ: colour is reduced to grey). `span`
  /// of the format is chosen here: large, but no stripe has more than `max_stripe` bytes and there are not
  /// too many. As another span sends all stripes, it stays from picture to picture while it fits. A stripe
  /// that is too long at the least span loses detail. Returns the stripes that changed, were reported missing
  /// or are due for their refresh, and the format; all of them after a change of format. No stripes and a
  /// `span` of 0: the picture has another size, or the format is out of bounds.
  Coded encode(const Picture& picture, const PictureFormat& format, std::size_t max_stripe, Time now);
  /// Notes that a receiver lacks stripes of the present format: they go with the next picture.
  void missing(std::span<const std::uint8_t> bits);
  /// Sends all stripes with the next picture.
  void reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Cuts stripes into pieces of at most `max_bytes` (and kMaxPicturePiece) with their headers; `header.pieces`
/// and `number` are set here. A picture without a change gives one piece without stripes. At most 255 pieces;
/// stripes that do not fit are left out.
std::vector<PicturePiece> cut(PictureHeader header, std::vector<Stripe> stripes, std::size_t max_bytes);

}  // namespace adit::perception

// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/stripe_encoder.hpp"

#include <algorithm>

#include "perception/camera/stripe_coding.hpp"

namespace adit::perception {
namespace {

bool fits_format(const Picture& picture, PictureFormat format) {
  format.span = static_cast<std::uint8_t>(std::min<std::uint32_t>(format.row(), 255));
  return format.is_valid() && picture.width == format.width && picture.height == format.height &&
         (picture.channels == 1 || picture.channels == 3) &&
         picture.bytes.size() == std::size_t{picture.width} * picture.height * picture.channels;
}

/// Part of the refresh time after which a stripe is due, in [1/2, 1): stripes that were sent together come
/// due one after the other.
double spread(std::uint32_t index) {
  return 0.5 + 0.5 * static_cast<double>(index * 0x9e3779b9U >> 8) / double{1 << 24};
}

}  // namespace

struct StripeEncoder::Impl {
  struct Sent {
    bool lacking{true};  ///< By a receiver, or never sent.
    Time due{};
    std::uint32_t digest{};
  };

  /// Codes with the present span, or another one where it does not fit or the format is another.
  CodedStripes code(const Picture& picture, PictureFormat wanted, std::size_t max_stripe) {
    wanted.span = format.span;
    CodedStripes coded;
    const bool same = wanted == format && format.span != 0;
    if (same) coded = CodedStripes(picture, format);
    if (!same || coded.longest() > max_stripe) {
      coded = code_with_new_span(picture, wanted, max_stripe);
      if (wanted != format) begin(wanted, coded.count());
    }
    return coded;
  }
  void begin(const PictureFormat& next, std::size_t stripes) {
    format = next;
    sent.assign(stripes, {});
    reference = {};
  }
  /// The stripes that changed, or that a receiver lacks.
  std::vector<bool> urgent(const Picture& picture) const {
    std::vector<bool> out(sent.size());
    if (!reference.bytes.empty()) mark_changed(reference, picture, format, params.change, out);
    for (std::size_t i = 0; i < sent.size(); ++i)
      if (sent[i].lacking) out[i] = true;
    return out;
  }
  /// Takes a larger span when all stripes are sent anyway, and it fits with room to spare.
  void widen(const Picture& picture, CodedStripes& coded, std::vector<bool>& which, std::size_t max_stripe) {
    if (std::ranges::find(which, false) != which.end()) return;
    std::size_t group = std::min<std::uint32_t>(format.row(), 255) / format.span;
    while (group > 1 && coded.longest(group) > max_stripe * 6 / 10) --group;
    if (group <= 1) return;
    PictureFormat wider = format;
    wider.span = static_cast<std::uint8_t>(wider.span * group);
    coded = CodedStripes(picture, wider);
    begin(wider, coded.count());
    which.assign(coded.count(), true);
  }
  Stripe send(const Picture& picture, const CodedStripes& coded, std::uint32_t index, bool refresh,
              Time now) {
    const auto data = coded.stripe(index);
    const Stripe stripe{static_cast<std::uint16_t>(index), {data.begin(), data.end()}};
    const double wait = seconds(params.refresh) * (refresh ? 1.0 : spread(index));
    sent[index] = {false, now + from_seconds(wait), stripe_digest(stripe.index, stripe.data)};
    copy_to_reference(picture, index);
    return stripe;
  }
  void copy_to_reference(const Picture& picture, std::uint32_t stripe) {
    const std::size_t channels = picture.channels;
    for_each_mcu(format, stripe, [&](std::uint32_t x, std::uint32_t y, std::uint32_t w, std::uint32_t h) {
      for (std::uint32_t v = y; v < y + h; ++v) {
        const std::size_t at = (std::size_t{v} * picture.width + x) * channels;
        std::copy_n(picture.bytes.data() + at, w * channels, reference.bytes.data() + at);
      }
    });
  }

  StripeParams params{};
  PictureFormat format{};
  std::vector<Sent> sent{};
  Picture reference{};  ///< Pixels of what was sent last, stripe by stripe.
};

StripeEncoder::StripeEncoder(StripeParams params) : impl_(std::make_unique<Impl>()) {
  impl_->params = params;
}
StripeEncoder::~StripeEncoder() = default;
StripeEncoder::StripeEncoder(StripeEncoder&&) noexcept = default;
StripeEncoder& StripeEncoder::operator=(StripeEncoder&&) noexcept = default;

StripeEncoder::Coded StripeEncoder::encode(const Picture& picture, const PictureFormat& format,
                                           std::size_t max_stripe, Time now) {
  Impl& self = *impl_;
  Coded out{format, {}, 0, false};
  out.format.span = 0;
  if (!fits_format(picture, format)) return out;
  const Picture pixels = in_channels_of(picture, format.colour);
  CodedStripes coded = self.code(pixels, format, max_stripe);
  std::vector<bool> urgent = self.urgent(pixels);
  self.widen(pixels, coded, urgent, max_stripe);
  if (self.reference.bytes.empty()) self.reference = pixels;
  for (std::uint32_t i = 0; i < coded.count(); ++i) {
    if (!urgent[i] && now < self.sent[i].due) continue;
    if (coded.stripe(i).size() > max_stripe) continue;  // Flat, and still too long: max_stripe is tiny.
    out.stripes.push_back(self.send(pixels, coded, i, !urgent[i], now));
  }
  out.format = self.format;
  out.whole = out.stripes.size() == coded.count();
  for (const Impl::Sent& sent : self.sent) out.digest += sent.digest;
  return out;
}

void StripeEncoder::missing(std::span<const std::uint8_t> bits) {
  for (std::size_t i = 0; i < impl_->sent.size() && i / 8 < bits.size(); ++i)
    if ((bits[i / 8] >> i % 8 & 1) != 0) impl_->sent[i].lacking = true;
}

void StripeEncoder::reset() {
  for (Impl::Sent& sent : impl_->sent) sent.lacking = true;
}

std::vector<PicturePiece> cut(PictureHeader header, std::vector<Stripe> stripes, std::size_t max_bytes) {
  constexpr std::size_t kMaxPieces = 255;
  max_bytes = std::min(max_bytes, kMaxPicturePiece);
  std::vector<PicturePiece> pieces(1);
  std::size_t used = kPictureHeaderBytes;
  for (Stripe& stripe : stripes) {
    const std::size_t needed = stripe.data.size() + kStripeBytes;
    if (kPictureHeaderBytes + needed > max_bytes || stripe.data.empty()) continue;
    if (used + needed > max_bytes) {
      if (pieces.size() == kMaxPieces) break;
      pieces.emplace_back();
      used = kPictureHeaderBytes;
    }
    pieces.back().stripes.push_back(std::move(stripe));
    used += needed;
  }
  header.pieces = static_cast<std::uint8_t>(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    header.number = static_cast<std::uint8_t>(i);
    pieces[i].header = header;
  }
  return pieces;
}

}  // namespace adit::perception

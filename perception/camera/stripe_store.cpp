// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/stripe_store.hpp"

#include <algorithm>

namespace adit::perception {
namespace {

std::vector<std::uint8_t> bits_of(const std::vector<bool>& marked) {
  if (std::ranges::find(marked, true) == marked.end()) return {};
  std::vector<std::uint8_t> bits((marked.size() + 7) / 8);
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | 1U << i % 8);
  return bits;
}

}  // namespace

void StripeStore::begin_picture(const PictureHeader& header) {
  const bool follows = newest_ && newest_->run == header.run && newest_->format == header.format;
  if (!newest_ || newest_->run != header.run) arrived_ = 0;
  if (!follows) {
    stripes_.assign(header.format.stripes(), {});
  } else {
    std::vector<bool> lost(stripes_.size(), header.frame != newest_->frame + 1);
    mark_gaps(lost, true);
    for (std::size_t i = 0; i < lost.size(); ++i)
      if (lost[i]) stripes_[i].doubtful = true;
  }
  newest_ = header;
  pieces_.assign(header.pieces, {});
}

bool StripeStore::take(const PicturePiece& piece) {
  const PictureHeader& header = piece.header;
  if (!header.format.is_valid() || header.number >= header.pieces) return false;
  const bool same_run = newest_ && newest_->run == header.run;
  if (same_run && header.frame < newest_->frame) {
    ++arrived_;
    return false;
  }
  if (!same_run || header.frame > newest_->frame) begin_picture(header);
  if (header.format != newest_->format || header.pieces != newest_->pieces || pieces_[header.number].here)
    return false;
  ++arrived_;
  newest_ = header;
  Seen& seen = pieces_[header.number];
  seen.here = true;
  for (const Stripe& stripe : piece.stripes) {
    if (stripe.index >= stripes_.size() || stripe.data.empty()) continue;
    stripes_[stripe.index] = {stripe.data, stripe_digest(stripe.index, stripe.data), false};
    if (seen.first < 0) seen.first = stripe.index;
    seen.last = stripe.index;
  }
  if (header.digest != 0 && is_complete()) {
    std::uint32_t digest = 0;
    for (const Held& held : stripes_) digest += held.digest;
    if (digest == header.digest)
      for (Held& held : stripes_) held.doubtful = false;
  }
  return true;
}

bool StripeStore::is_complete() const {
  return newest_ && std::ranges::all_of(pieces_, [](const Seen& seen) { return seen.here; });
}

void StripeStore::mark_gaps(std::vector<bool>& marked, bool late_too) const {
  std::size_t next = 0;  // The stripe after the last one that came.
  bool gap = false;
  const auto mark_until = [&](std::size_t end) {
    for (std::size_t i = next; gap && i < std::min(end, marked.size()); ++i) marked[i] = true;
    gap = false;
  };
  for (const Seen& seen : pieces_) {
    if (!seen.here) {
      gap = true;
    } else if (seen.first >= 0) {
      mark_until(static_cast<std::size_t>(seen.first));
      next = static_cast<std::size_t>(seen.last) + 1;
    }
  }
  if (late_too || (!pieces_.empty() && pieces_.back().here)) mark_until(marked.size());
}

std::vector<std::uint8_t> StripeStore::missing(bool late_too) const {
  std::vector<bool> marked(stripes_.size());
  mark_gaps(marked, late_too);
  for (std::size_t i = 0; i < stripes_.size(); ++i)
    if (stripes_[i].doubtful || stripes_[i].data.empty()) marked[i] = true;
  return bits_of(marked);
}

std::vector<std::uint8_t> StripeStore::absent() const {
  std::vector<bool> marked(stripes_.size());
  for (std::size_t i = 0; i < stripes_.size(); ++i) marked[i] = stripes_[i].data.empty();
  return bits_of(marked);
}

std::vector<std::uint8_t> StripeStore::as_jpeg() const {
  if (!newest_) return {};
  std::vector<const std::vector<std::uint8_t>*> stripes;
  stripes.reserve(stripes_.size());
  for (const Held& held : stripes_) stripes.push_back(&held.data);
  return jpeg_of(newest_->format, stripes);
}

}  // namespace adit::perception

// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/air.hpp"

#include "core/wire/cost.hpp"

namespace adit::bench {
namespace {

constexpr int kBulkPriority = 5;  // See core/wire/link.hpp.

}  // namespace

Air::Air(const wire::LinkProfile& link, std::uint64_t seed, std::size_t robots)
    : link_(link),
      scheduler_(VirtualParams{.seed = seed, .workers = 1}),
      radio_(std::make_shared<wire::Radio>(scheduler_, seed, link, 100us)),
      sent_(robots + 1) {
  radio_->add("station", false);
  for (std::size_t i = 0; i < robots; ++i) radio_->add("robot " + std::to_string(i), false);
}

void Air::send(int from, int to, std::size_t payload, std::function<void()> arrived) {
  const std::uint32_t frame = link_.frame_bytes();
  wire::Datagram datagram;
  datagram.bytes = wire::WireCost::sample(payload, frame);
  datagram.frames = wire::WireCost::frames(payload, frame);
  datagram.priority = kBulkPriority;
  put(from, to, std::move(datagram), std::move(arrived));
}

void Air::control(int from, int to, std::uint32_t bytes, std::function<void()> arrived) {
  wire::Datagram datagram;
  datagram.bytes = bytes;
  datagram.priority = wire::WireCost::kDiscoveryPriority;
  put(from, to, std::move(datagram), std::move(arrived));
}

void Air::put(int from, int to, wire::Datagram datagram, std::function<void()> arrived) {
  datagram.sent = [this, from, bytes = datagram.bytes, frames = datagram.frames] {
    Count& count = sent_[static_cast<std::size_t>(from)];
    count.bytes += bytes;
    count.datagrams += frames;
  };
  datagram.arrived = [arrived = std::move(arrived), frames = datagram.frames](int, std::uint16_t came) {
    if (came == frames) arrived();
  };
  radio_->send(from, to, std::move(datagram));
}

std::size_t Air::backlog(int node) const { return radio_->backlog(node, kBulkPriority); }

void Air::cut(bool is_cut) {
  if (is_cut == cut_.has_value()) return;
  if (is_cut) {
    cut_ = radio_->disturbances().add({.cut = true});
  } else {
    radio_->disturbances().end(*cut_);
    cut_.reset();
  }
}

std::size_t Air::room() const { return link_.frame_bytes() - wire::WireCost::kData; }

Air::Count Air::sent_by_robots() const {
  Count out;
  for (std::size_t i = 1; i < sent_.size(); ++i) {
    out.bytes += sent_[i].bytes;
    out.datagrams += sent_[i].datagrams;
  }
  return out;
}

}  // namespace adit::bench

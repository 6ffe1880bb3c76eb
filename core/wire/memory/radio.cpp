// SPDX-License-Identifier: Apache-2.0
#include "core/wire/memory/radio.hpp"

#include <algorithm>

namespace adit::wire {

int Radio::add(std::string machine, bool is_local) {
  RadioNode node;
  node.machine = std::move(machine);
  node.is_local = is_local;
  nodes_.push_back(std::move(node));
  return static_cast<int>(nodes_.size()) - 1;
}

void Radio::set_link(const std::string& a, const std::string& b, const LinkProfile& profile) {
  links_[std::minmax(a, b)] = profile;
}

const LinkProfile& Radio::profile(const std::string& a, const std::string& b) const {
  if (links_.empty()) return standard_;
  const auto found = links_.find(std::minmax(a, b));
  return found == links_.end() ? standard_ : found->second;
}

std::uint32_t Radio::frame_bytes(int node) const {
  std::uint32_t smallest = standard_.frame_bytes();
  for (const auto& [pair, link] : links_) {
    if (pair.first == machine(node) || pair.second == machine(node))
      smallest = std::min(smallest, link.frame_bytes());
  }
  return smallest;
}

Path Radio::path(const std::string& from, const std::string& to) const {
  const auto a = positions_.find(from), b = positions_.find(to);
  if (a == positions_.end() || b == positions_.end()) return {};
  Path result;
  result.distance = distance(a->second, b->second);
  if (walls_ && profile(from, to).fading > 0.0) result.walls = walls_(a->second, b->second);
  return result;
}

std::optional<double> Radio::signal(const std::string& from, const std::string& to) const {
  return received_power(profile(from, to), path(from, to));
}

void Radio::after(Duration delay, Task task) {
  scheduler_.at(scheduler_.elapsed() + delay, [weak = weak_from_this(), task = std::move(task)] {
    const auto self = weak.lock();
    if (self && !self->closed_) task();
  });
}

void Radio::multicast(int from, std::vector<int> to, Datagram datagram) {
  RadioNode& node = nodes_[static_cast<std::size_t>(from)];
  if (closed_ || !node.on || to.empty()) return;
  auto shared = std::make_shared<Datagram>(std::move(datagram));
  if (node.is_local) {
    if (shared->sent) shared->sent();
    after(inner_latency_, [self = this, shared, from, to = std::move(to)] {
      if (!self->is_on(from)) return;
      for (const int node_to : to) {
        if (self->is_on(node_to)) shared->arrived(node_to, shared->frames);
      }
    });
    return;
  }
  Duration longest{};
  for (const int node_to : to)
    longest = std::max(longest, max_queue_age(profile(from, node_to), shared->priority));
  auto packet = std::make_shared<Packet>();
  packet->through.resize(to.size());
  packet->to = std::move(to);
  packet->datagram = shared;
  std::uint64_t number = shared->supersedes;
  if (number != 0) number ^= (static_cast<std::uint64_t>(packet->to.front()) + 1) * 0x9e3779b97f4a7c15ULL;
  const Duration cost = airtime(from, *packet);
  const auto replaced = node.queue.push({.item = std::move(packet),
                                         .frames = shared->frames,
                                         .priority = shared->priority,
                                         .supersedes = number,
                                         .again = shared->again,
                                         .since = scheduler_.elapsed(),
                                         .max_queue_age = longest,
                                         .airtime = cost});
  if (replaced && (*replaced)->datagram->lost) {
    for (const int node_to : (*replaced)->to) (*replaced)->datagram->lost(node_to);
  }
  if (!node.busy) pump(from);
}

Duration Radio::airtime(int from, const Packet& packet) const {
  double slowest = 1e12;
  for (const int to : packet.to) {
    const double slower = disturbances_.none() ? 1.0 : disturbances_.on(machine(from), machine(to)).slower;
    const LinkProfile& link = profile(from, to);
    slowest = std::min(slowest, (link.window > 0.0 ? 1e12 : link.bandwidth) / slower);
  }
  return from_seconds(packet.datagram->bytes * 8.0 / packet.datagram->frames / slowest);
}

SenderState Radio::sender(int node) const {
  const RadioNode& sender = nodes_[static_cast<std::size_t>(node)];
  if (sender.is_local) return {};
  return {&standard_, sender.queue.waiting(), sender.queue.dropped()};
}

void Radio::pump(int index) {
  RadioNode& node = nodes_[static_cast<std::size_t>(index)];
  node.busy = false;
  ++node.asked;
  if (!node.on) return node.queue.clear();
  const auto cost = [this, index](const std::shared_ptr<Packet>& packet) { return airtime(index, *packet); };
  const auto drop = [](const std::shared_ptr<Packet>& packet) {
    if (!packet->datagram->lost) return;
    for (const int to : packet->to) packet->datagram->lost(to);
  };
  const auto next = node.queue.next(scheduler_.elapsed(), cost, drop);
  if (next) {
    node.busy = true;
    put_on_air(index, next->message.item, next->last, next->airtime);
    after(next->airtime, [self = this, index] { self->pump(index); });
  } else if (const auto at = node.queue.ready(scheduler_.elapsed())) {
    after(*at - scheduler_.elapsed(), [self = this, index, asked = node.asked] {
      const RadioNode& waiting = self->nodes_[static_cast<std::size_t>(index)];
      if (!waiting.busy && waiting.asked == asked) self->pump(index);
    });
  }
}

void Radio::put_on_air(int from, const std::shared_ptr<Packet>& packet, bool last, Duration airtime) {
  Datagram& datagram = *packet->datagram;
  if (last && datagram.sent) datagram.sent();
  const std::uint32_t bytes = datagram.bytes / datagram.frames;
  RadioNode& node = nodes_[static_cast<std::size_t>(from)];
  for (std::size_t i = 0; i < packet->to.size(); ++i) {
    const int to = packet->to[i];
    const LinkProfile& link = profile(from, to);
    const Disturbances::Effect effect =
        disturbances_.none() ? Disturbances::Effect{} : disturbances_.on(machine(from), machine(to));
    const bool admitted = link.window <= 0.0 || i > 0 || node.window.admit(link, bytes, scheduler_.elapsed());
    if (!admitted && last) node.queue.note_dropped(datagram.priority);
    if (admitted && !lost(from, to, bytes, effect)) ++packet->through[i];
    if (!last) continue;
    const std::uint16_t through = packet->through[i];
    Duration delay = airtime + transit(link, random_) + effect.delay;
    if (effect.reorder > 0.0 && random_.chance(effect.reorder))
      delay += from_seconds(random_.uniform() * seconds(effect.reorder_by));
    arrive(from, to, packet->datagram, through, delay);
    if (effect.duplicate > 0.0 && through == datagram.frames && random_.chance(effect.duplicate))
      arrive(from, to, packet->datagram, through, delay + from_seconds(random_.uniform(0.0, 0.05)));
  }
}

void Radio::arrive(int from, int to, const std::shared_ptr<Datagram>& datagram, std::uint16_t through,
                   Duration delay) {
  after(delay, [self = this, datagram, from, to, through] {
    if (through > 0 && self->is_on(to) && self->is_on(from)) {
      datagram->arrived(to, through);
    } else if (datagram->lost) {
      datagram->lost(to);
    }
  });
}

bool Radio::lost(int from, int to, std::uint32_t bytes, const Disturbances::Effect& effect) {
  if (effect.cut) return true;
  const LinkProfile& link = profile(from, to);
  const Path between = link.range > 0.0 || link.fading > 0.0 ? path(machine(from), machine(to)) : Path{};
  return loss_models_[{from, to}].lost(link, between, bytes, effect.loss, random_);
}

}  // namespace adit::wire

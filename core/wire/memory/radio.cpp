#include "core/wire/memory/radio.hpp"

#include <algorithm>
#include <cmath>

namespace adit::wire {

int Radio::add(std::string machine, bool inner) {
  Node node;
  node.machine = std::move(machine);
  node.inner = inner;
  nodes_.push_back(std::move(node));
  return static_cast<int>(nodes_.size()) - 1;
}

void Radio::set_link(const std::string& a, const std::string& b, const LinkProfile& profile) {
  link(a, b).profile = profile;
}

void Radio::cut(const std::string& a, const std::string& b, bool is_cut) { link(a, b).cut = is_cut; }

void Radio::degrade(const std::string& a, const std::string& b, std::optional<double> loss) {
  link(a, b).loss = loss;
}

const Radio::Link* Radio::find(int from, int to) const {
  const std::string& a = machine(from);
  const std::string& b = machine(to);
  const auto found = links_.find(a < b ? std::pair(a, b) : std::pair(b, a));
  return found == links_.end() ? nullptr : &found->second;
}

const LinkProfile& Radio::profile(int from, int to) const {
  const Link* own = find(from, to);
  return own != nullptr && own->profile ? *own->profile : standard_;
}

void Radio::after(Duration delay, Task task) {
  scheduler_.at(scheduler_.elapsed() + delay, [weak = weak_from_this(), task = std::move(task)] {
    const auto self = weak.lock();
    if (self && !self->closed_) task();
  });
}

void Radio::multicast(int from, std::vector<int> to, Datagram datagram) {
  Node& node = nodes_[static_cast<std::size_t>(from)];
  if (closed_ || !node.on || to.empty()) return;
  auto shared = std::make_shared<Datagram>(std::move(datagram));
  if (node.inner) {
    if (shared->sent) shared->sent();
    after(inner_latency_, [self = this, shared, from, to = std::move(to)] {
      if (!self->is_on(from)) return;
      for (const int node_to : to) {
        if (self->is_on(node_to)) shared->arrived(node_to, shared->frames);
      }
    });
    return;
  }
  auto& queue = node.queues[static_cast<std::size_t>(std::clamp(shared->priority, 0, 6))];
  if (shared->supersedes != 0) {
    for (Waiting& waiting : queue) {
      if (waiting.datagram->supersedes != shared->supersedes || waiting.to != to) continue;
      if (waiting.datagram->lost) {
        for (const int node_to : to) waiting.datagram->lost(node_to);
      }
      waiting.datagram = std::move(shared);
      waiting.since = scheduler_.elapsed();
      return;
    }
  }
  queue.push_back({std::move(shared), std::move(to), scheduler_.elapsed()});
  if (!node.busy) pump(from);
}

void Radio::pump(int index) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  node.busy = false;
  if (!node.on) {
    for (auto& queue : node.queues) queue.clear();
    return;
  }
  for (auto& queue : node.queues) {
    while (!queue.empty()) {
      const Waiting item = std::move(queue.front());
      queue.pop_front();
      // Multicast goes out at the rate of the slowest of those it is meant for.
      double bandwidth = profile(index, item.to.front()).bandwidth, patience = 0.0;
      for (const int to : item.to) {
        bandwidth = std::min(bandwidth, profile(index, to).bandwidth);
        patience = std::max(patience, profile(index, to).queue);
      }
      if (seconds(scheduler_.elapsed() - item.since) > patience) {
        if (item.datagram->lost) {
          for (const int to : item.to) item.datagram->lost(to);
        }
        continue;
      }
      const Duration airtime = from_seconds(item.datagram->bytes * 8.0 / bandwidth);
      node.busy = true;
      transmit(index, item, airtime);
      after(airtime, [self = this, index] { self->pump(index); });
      return;
    }
  }
}

void Radio::transmit(int from, const Waiting& item, Duration airtime) {
  if (item.datagram->sent) item.datagram->sent();
  for (const int to : item.to) {
    const std::uint16_t through = frames_through(from, to, item.datagram->frames);
    const Duration delay = airtime + from_seconds(profile(from, to).latency);
    after(delay, [self = this, datagram = item.datagram, from, to, through] {
      if (through > 0 && self->is_on(to) && self->is_on(from)) {
        datagram->arrived(to, through);
      } else if (datagram->lost) {
        datagram->lost(to);
      }
    });
  }
}

std::uint16_t Radio::frames_through(int from, int to, std::uint16_t frames) {
  const Link* own = find(from, to);
  const LinkProfile& link_profile = profile(from, to);
  if (own != nullptr && own->cut) return 0;
  if (link_profile.range > 0.0) {
    const auto a = positions_.find(machine(from)), b = positions_.find(machine(to));
    if (a != positions_.end() && b != positions_.end()) {
      const double distance =
          std::hypot(a->second[0] - b->second[0], a->second[1] - b->second[1], a->second[2] - b->second[2]);
      if (distance > link_profile.range) return 0;
    }
  }
  const double loss = own != nullptr && own->loss ? *own->loss : link_profile.loss;
  std::uint16_t through = 0;
  for (std::uint16_t i = 0; i < frames; ++i) {
    if (!random_.chance(loss)) ++through;
  }
  return through;
}

}  // namespace adit::wire

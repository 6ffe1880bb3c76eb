// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/exec/virtual_runtime.hpp"
#include "core/time/random.hpp"
#include "core/wire/link/model.hpp"
#include "core/wire/link/transmit_queue.hpp"
#include "core/wire/link_state.hpp"
#include "core/wire/memory/disturbance.hpp"

namespace adit::wire {

/// A transmission of a participant: its sizes and callbacks, never its content.
struct Datagram {
  std::uint32_t bytes{};  ///< Headers included, all frames together.
  std::uint16_t frames{1};
  int priority{};                ///< Priority as in core/wire/link/budget.hpp.
  std::uint64_t supersedes{};    ///< Not 0: replaces a queued datagram of this number to the same node.
  bool again{};                  ///< It repeats the replaced one, which then does not count as lost.
  std::function<void()> sent{};  ///< Called when it was transmitted.
  /// Called with the number of frames that arrived, at least one.
  std::function<void(int to, std::uint16_t frames)> arrived{};
  std::function<void(int to)> lost{};  ///< Called when no frame arrived, or it was dropped at the sender.
};

/// The rehearsal's radio, built on the link model: one transmit queue per node, latency and loss per pair of
/// machines and direction, and faults. Local nodes have a perfect network.
class Radio : public std::enable_shared_from_this<Radio> {
 public:
  Radio(VirtualScheduler& scheduler, std::uint64_t seed, LinkProfile standard, Duration inner_latency)
      : scheduler_(scheduler), random_(seed), standard_(std::move(standard)), inner_latency_(inner_latency) {}

  /// Adds a transmitter and receiver; nodes are numbered from 0, and numbers are never reused.
  int add(std::string machine, bool is_local);
  /// Switches a node off: it sends and receives nothing more, and its queue is dropped.
  void remove(int node) { nodes_[static_cast<std::size_t>(node)].on = false; }
  /// Switches the radio off: all nodes are silent, and frames in transit are dropped.
  void close() { closed_ = true; }
  bool is_on(int node) const { return nodes_[static_cast<std::size_t>(node)].on; }
  const std::string& machine(int node) const { return nodes_[static_cast<std::size_t>(node)].machine; }
  bool is_local_domain(int node) const { return nodes_[static_cast<std::size_t>(node)].is_local; }
  /// Largest frame that the node may send to any other, bytes.
  std::uint32_t frame_bytes(int node) const;
  /// Number of messages of that priority queued at the node.
  std::size_t backlog(int node, int priority) const {
    return nodes_[static_cast<std::size_t>(node)].queue.size(priority);
  }
  /// Queueing time of the node's oldest message.
  Duration waiting(int node) const {
    return nodes_[static_cast<std::size_t>(node)].queue.oldest(scheduler_.elapsed());
  }

  /// State of the node's queue, and its dropped messages.
  SenderState sender(int node) const;

  void send(int from, int to, Datagram datagram) { multicast(from, {to}, std::move(datagram)); }
  /// Sends one transmission that all of `to` can receive.
  void multicast(int from, std::vector<int> to, Datagram datagram);

  void set_link(const std::string& a, const std::string& b, const LinkProfile& profile);
  void set_position(const std::string& machine, Position position) { positions_[machine] = position; }
  void set_attenuation(Attenuation walls) { walls_ = std::move(walls); }
  /// Mean received power, dBm, when the link fades and both positions are known.
  std::optional<double> signal(const std::string& from, const std::string& to) const;
  Disturbances& disturbances() { return disturbances_; }

 private:
  struct Packet {
    std::shared_ptr<Datagram> datagram{};
    std::vector<int> to{};
    std::vector<std::uint16_t> through{};  // Frames that arrived, by receiver.
  };
  struct RadioNode {
    std::string machine{};
    bool is_local{};
    bool on{true};
    bool busy{};
    std::uint64_t asked{};  // Only the latest wake-up counts; earlier ones are void.
    TransmitQueue<std::shared_ptr<Packet>> queue{};
    Window window{};
  };
  using Pair = std::pair<std::string, std::string>;

  const LinkProfile& profile(const std::string& a, const std::string& b) const;
  const LinkProfile& profile(int from, int to) const { return profile(machine(from), machine(to)); }
  Path path(const std::string& from, const std::string& to) const;
  /// Airtime of one frame from that node; multicast is sent at the rate of the slowest receiver.
  Duration airtime(int from, const Packet& packet) const;
  void pump(int node);
  void put_on_air(int node, const std::shared_ptr<Packet>& packet, bool last, Duration airtime);
  void arrive(int from, int to, const std::shared_ptr<Datagram>& datagram, std::uint16_t through,
              Duration delay);
  bool lost(int from, int to, std::uint32_t bytes, const Disturbances::Effect& effect);
  void after(Duration delay, Task task);

  VirtualScheduler& scheduler_;
  Random random_;
  LinkProfile standard_;
  Duration inner_latency_;
  std::deque<RadioNode> nodes_{};
  std::map<Pair, LinkProfile> links_{};
  std::map<std::pair<int, int>, LossModel> loss_models_{};  // By sender and receiver.
  std::map<std::string, Position> positions_{};
  Attenuation walls_{};
  Disturbances disturbances_{};
  bool closed_{};
};

}  // namespace adit::wire

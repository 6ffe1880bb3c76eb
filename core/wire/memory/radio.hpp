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
#include "core/wire/link.hpp"

namespace adit::wire {

/// What a participant puts on the air: sizes and what becomes of it, never its content.
struct Datagram {
  std::uint32_t bytes{};  ///< headers included, all frames together
  std::uint16_t frames{1};
  int priority{};                ///< 0 goes first, up to 6
  std::uint64_t supersedes{};    ///< not 0: replaces a waiting datagram of this number to the same node
  std::function<void()> sent{};  ///< it went on the air
  std::function<void(int to, std::uint16_t frames)> arrived{};  ///< so many of its frames, at least one
  std::function<void(int to)> lost{};  ///< none of its frames, or dropped at the sender
};

/// The radio model: one transmitter per node that sends one datagram after another, by priority; latency,
/// loss per frame, range and cuts per pair of machines. Inner nodes have a perfect network.
class Radio : public std::enable_shared_from_this<Radio> {
 public:
  Radio(VirtualScheduler& scheduler, std::uint64_t seed, LinkProfile standard, Duration inner_latency)
      : scheduler_(scheduler), random_(seed), standard_(std::move(standard)), inner_latency_(inner_latency) {}

  /// A new transmitter and receiver; nodes are numbered from 0 and never reused.
  int add(std::string machine, bool inner);
  /// Nothing is sent or received there any more; what waits to be sent is forgotten.
  void remove(int node) { nodes_[static_cast<std::size_t>(node)].on = false; }
  /// Everything falls silent; what is in the air is forgotten.
  void close() { closed_ = true; }
  bool is_on(int node) const { return nodes_[static_cast<std::size_t>(node)].on; }
  const std::string& machine(int node) const { return nodes_[static_cast<std::size_t>(node)].machine; }
  bool inner(int node) const { return nodes_[static_cast<std::size_t>(node)].inner; }

  void send(int from, int to, Datagram datagram) { multicast(from, {to}, std::move(datagram)); }
  /// One transmission, heard by all of `to`.
  void multicast(int from, std::vector<int> to, Datagram datagram);

  void set_link(const std::string& a, const std::string& b, const LinkProfile& profile);
  void cut(const std::string& a, const std::string& b, bool is_cut);
  void degrade(const std::string& a, const std::string& b, std::optional<double> loss);
  void set_position(const std::string& machine, double x, double y, double z) {
    positions_[machine] = {x, y, z};
  }

 private:
  struct Waiting {
    std::shared_ptr<Datagram> datagram{};
    std::vector<int> to{};
    Duration since{};
  };
  struct Node {
    std::string machine{};
    bool inner{};
    bool on{true};
    bool busy{};
    std::array<std::deque<Waiting>, 7> queues{};
  };
  struct Link {
    std::optional<LinkProfile> profile{};
    std::optional<double> loss{};
    bool cut{};
  };

  Link& link(const std::string& a, const std::string& b) { return a < b ? links_[{a, b}] : links_[{b, a}]; }
  const Link* find(int from, int to) const;
  const LinkProfile& profile(int from, int to) const;
  void pump(int node);
  void transmit(int node, const Waiting& item, Duration airtime);
  std::uint16_t frames_through(int from, int to, std::uint16_t frames);
  void after(Duration delay, Task task);

  VirtualScheduler& scheduler_;
  Random random_;
  LinkProfile standard_;
  Duration inner_latency_;
  std::deque<Node> nodes_{};
  std::map<std::pair<std::string, std::string>, Link> links_{};
  std::map<std::string, std::array<double, 3>> positions_{};
  bool closed_{};
};

}  // namespace adit::wire

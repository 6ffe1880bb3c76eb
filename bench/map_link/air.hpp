// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/exec/virtual_runtime.hpp"
#include "core/wire/memory/radio.hpp"

namespace adit::bench {

/// The radio of rehearsals between some robots and one station, with a count of all bytes.
class Air {
 public:
  /// Bytes on the air, headers included, and datagrams.
  struct Count {
    std::uint64_t bytes{}, datagrams{};
  };

  Air(const wire::LinkProfile& link, std::uint64_t seed, std::size_t robots);

  static constexpr int kStation = 0;
  static int robot(std::size_t index) { return static_cast<int>(index) + 1; }

  /// Sends a message of `payload` serialised bytes as Fast DDS would, in class `bulk`; `arrived` is called
  /// when all of its frames came.
  void send(int from, int to, std::size_t payload, std::function<void()> arrived);
  /// Sends one frame of `bytes`, headers included, in the class of acknowledgements.
  void control(int from, int to, std::uint32_t bytes, std::function<void()> arrived);
  /// Messages that wait at a sender.
  std::size_t backlog(int node) const;
  wire::SenderState sender(int node) const { return radio_->sender(node); }
  /// Nothing passes while it is cut.
  void cut(bool is_cut);
  bool is_cut() const { return cut_.has_value(); }

  const wire::LinkProfile& link() const { return link_; }
  /// Largest content of one frame, bytes.
  std::size_t room() const;
  Time now() const { return Time(1000s) + scheduler_.elapsed(); }
  void run(Duration span) { scheduler_.run_until(scheduler_.elapsed() + span); }
  /// What a node sent so far.
  const Count& sent(int node) const { return sent_[static_cast<std::size_t>(node)]; }
  Count sent_by_robots() const;

 private:
  void put(int from, int to, wire::Datagram datagram, std::function<void()> arrived);

  wire::LinkProfile link_;
  VirtualScheduler scheduler_;
  std::shared_ptr<wire::Radio> radio_;
  std::vector<Count> sent_;
  std::optional<wire::DisturbanceId> cut_{};
};

}  // namespace adit::bench

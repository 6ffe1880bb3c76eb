// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

namespace adit::station::host {

/// The queue of lines for one client of the station, in the order of their events.
///
/// A reply is never dropped: a client with too many unread replies must be disconnected. Events are bounded:
/// the oldest is dropped for a new one, and the client reads how many it missed.
class Outbox {
 public:
  static constexpr std::size_t kMaxReplyBytes = 4 << 20;
  static constexpr std::size_t kMaxEvents = 256;

  /// Queues a reply. Returns false if more than `kMaxReplyBytes` of replies are queued.
  [[nodiscard]] bool reply(std::string line);
  void event(std::string line);
  /// Counts events that were lost before they were queued here.
  void lost(std::size_t events) { missed_ += events; }
  /// Drops all queued lines.
  void clear();

  /// The next line to send.
  std::optional<std::string> next();
  bool empty() const { return waiting_.empty() && missed_ == 0; }

 private:
  struct Line {
    bool is_event{};
    std::string text{};
  };
  std::deque<Line> waiting_{};
  std::size_t reply_bytes_{};
  std::size_t events_{};
  std::size_t missed_{};
};

}  // namespace adit::station::host

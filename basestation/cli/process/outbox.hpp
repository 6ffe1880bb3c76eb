#pragma once
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

namespace adit::station::cli {

/// The lines that wait for one client of the station, in the order in which they arose.
///
/// A reply is never dropped: a client that lets too many wait has to be cut off. Events are bounded: the
/// oldest makes room for a new one, and the client reads how many it missed. Of snapshots only the newest
/// waits.
class Outbox {
 public:
  static constexpr std::size_t kMaxReplyBytes = 4 << 20;
  static constexpr std::size_t kMaxEvents = 256;

  /// False when more than `kMaxReplyBytes` of replies wait.
  [[nodiscard]] bool reply(std::string line);
  void event(std::string line);
  void snapshot(std::string line);
  /// So many events were lost before they came here.
  void lost(std::size_t events) { missed_ += events; }
  /// Everything is dropped.
  void clear();

  /// The next line to send. `client_is_done`: the client has read all that was sent; a snapshot waits for
  /// that, so that a client which was busy gets the newest one instead of all those that it missed.
  std::optional<std::string> next(bool client_is_done);
  bool empty() const { return waiting_.empty() && missed_ == 0; }

 private:
  enum class Kind { reply, event, snapshot };
  struct Line {
    Kind kind{};
    std::string text{};
  };
  std::deque<Line> waiting_{};
  std::size_t reply_bytes_{};
  std::size_t events_{};
  std::size_t missed_{};
};

}  // namespace adit::station::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/time/time.hpp"
#include "core/transfer/piece.hpp"

namespace adit::transfer {

/// Parameters of Receiver.
struct ReceiverParams {
  Duration slow{1s};             ///< Shortest time between two acknowledgements on a thin link.
  Duration fast{250ms};          ///< The same on others.
  double thin{1e6};              ///< A link of a lower bandwidth is thin, bit/s.
  Duration idle{2s};             ///< Period of acknowledgements while nothing arrives.
  std::size_t max_senders{64};   ///< Senders that are remembered.
  std::size_t max_receipts{16};  ///< Receipts in one acknowledgement.
};

/// Records which pieces arrived, and says when to acknowledge them. Pieces may come late, twice or in another
/// order. A pure state machine.
class Receiver {
 public:
  explicit Receiver(ReceiverParams params = {}) : params_(params) {}

  /// Records a piece. Returns false if it came before.
  bool take(const std::string& sender, std::uint32_t session, std::uint32_t id, Time now);
  /// The receipts to acknowledge now, by sender, for one message; an empty list is sent, too: it shows that
  /// this receiver is there. Nothing: it is not time. `bandwidth`: of the own link, bit/s; 0: unknown.
  std::optional<std::vector<std::pair<std::string, Receipt>>> due(Time now, double bandwidth);
  /// Notes that a piece could not be used: the sender is to hear soon that it did not arrive.
  void refused(const std::string& sender);
  /// A sender may not know this receiver yet: the next call of due() after `slow` or `fast` answers.
  void greet() { news_ = true; }

 private:
  /// The pieces that arrived of one sender, and what to acknowledge.
  struct Reception {
    Receipt receipt{};
    bool news{};
    bool again{};  ///< Its last receipt went out once, and may have been lost.
    Time heard{};
    std::optional<Time> acknowledged{};
  };
  ReceiverParams params_;
  std::map<std::string, Reception> senders_{};
  std::string
      turn_{};  ///< The last sender in an acknowledgement that was full: the next one begins after it.
  bool news_{true};
  std::optional<Time> acknowledged_{};
};

}  // namespace adit::transfer

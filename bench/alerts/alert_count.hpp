// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>
#include <string>

#include "basestation/alert/queue.hpp"

namespace adit::bench {

/// Counts how often one operator is called: rows of the alert queue that appear, and rows that he had seen
/// and that a new notification shows again. He looks at each row after `kHandled` and says that he has seen
/// it.
class AlertCount {
 public:
  static constexpr double kHandled = 10.0;  ///< Time for one row, s.

  /// The station's world at that time, s. Call it several times a second.
  void look(const station::World& world, double now);

  const station::AlertQueue& queue() const { return queue_; }
  int urgent() const { return urgent_; }  ///< Priority `act`.
  int soon() const { return soon_; }
  const std::map<std::string, int>& by_code() const { return by_code_; }
  /// What called him, in the order of time: "12.3 s r1 blocked".
  const std::vector<std::string>& calls() const { return calls_; }

 private:
  void count(const station::Alert& alert, double now);

  station::AlertQueue queue_{};
  std::uint64_t newest_notice_{};
  std::map<std::uint64_t, double> unseen_since_{};  ///< By alert, s.
  int urgent_{}, soon_{};
  std::map<std::string, int> by_code_{};
  std::vector<std::string> calls_{};
};

}  // namespace adit::bench

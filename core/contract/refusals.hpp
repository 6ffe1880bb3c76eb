// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>

#include "core/time/time.hpp"
#include "core/wire/participant.hpp"

namespace adit::contract {

/// The counts that are not zero, as "forged 12, number jump 3".
std::string describe(const wire::RefusalCounts& counts);

/// Chooses which refusals are news: the first of a kind, and the first after kQuiet without one.
class RefusalNews {
 public:
  static constexpr Duration kQuiet = std::chrono::seconds(60);
  /// Takes the counts since the start. Returns what there is to report, as describe(); empty: nothing.
  std::string told(const wire::RefusalCounts& counts, Time now);

 private:
  struct Kind {
    std::uint64_t count{};
    Time seen{};  ///< When the count last grew.
  };
  std::array<Kind, wire::kRefusals> kinds_{};
};

}  // namespace adit::contract

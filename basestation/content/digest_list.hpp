// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "basestation/map/chunk_store.hpp"
#include "core/transfer/piece.hpp"

namespace adit::station {

/// Chooses the digests of maps that go with an acknowledgement, so that robots that carry maps do not send
/// what is here: a few at a time, in turn.
class DigestList {
 public:
  static constexpr Duration kPeriod = 4s;
  static constexpr std::size_t kMaxDigests = 3;
  static constexpr double kThin = 250e3;  ///< One at a time below, bit/s.

  struct Digests {
    std::vector<transfer::ContentDigest> list{};
    bool all{false};  ///< There are no other maps.
  };
  /// The digests to send now; nothing: it is not time. `receipts`: number of receipts in the acknowledgement.
  /// `bandwidth`: of the own link, bit/s; 0: unknown.
  std::optional<Digests> due(const ChunkStore& chunks, std::size_t receipts, double bandwidth, Time now);

 private:
  std::optional<Time> sent_{};
  std::string last_{};  ///< The robot whose digest went last.
};

}  // namespace adit::station

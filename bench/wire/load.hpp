// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/wire/link.hpp"
#include "core/wire/participant.hpp"

namespace adit::bench {

/// Topics of the classes `bulk` and `video`, as maps and pictures will be: pieces that are usable alone.
inline constexpr wire::TopicInfo kLoadBulk{"adit/load_bulk", "Piece", wire::QosClass::bulk, 16, false, 4096};
inline constexpr wire::TopicInfo kLoadVideo{
    "adit/load_video", "Piece", wire::QosClass::video, 1, false, 16384};

/// Fills a link: offers all its bandwidth as `bulk` and half of it as `video`, and reads what others offer.
/// Construct and destroy it on its strand.
class Load {
 public:
  /// `who` distinguishes the pieces of several loads.
  Load(wire::Participant& wire, Executor& strand, const wire::LinkProfile& link, std::uint8_t who);

 private:
  void offer(const wire::TopicInfo& topic, std::size_t bytes, double share, Executor& strand,
             wire::Participant& wire, const wire::LinkProfile& link, std::uint8_t who);
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
  std::vector<Timer> timers_{};
};

}  // namespace adit::bench

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <mutex>
#include <optional>

#include "core/time/time.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Keeps to one participant that writes a topic: while it is heard, the samples of others are left out. Two
/// sources of odometry or scans would move the robot to and fro in its map. Safe to call from any thread, as
/// two strands that read one topic must keep to the same source.
class OneSource {
 public:
  /// After this silence another participant becomes the source.
  static constexpr Duration kGone{500ms};
  /// So many samples of another one within kWindow are no remains of a driver that was restarted.
  static constexpr int kSamples{3};
  static constexpr Duration kWindow{2s};

  enum class Use : unsigned char {
    yes,
    no,       ///< It is from another participant than the source.
    besides,  ///< It is from the source, and another one writes, too.
  };

  Use take(const wire::ParticipantId& sender, Time received) {
    const std::lock_guard lock(mutex_);
    if (!source_ || (sender != *source_ && received - heard_ > kGone)) {
      source_ = sender;
      others_ = 0;
    }
    if (sender == *source_) {
      heard_ = received;
      const bool besides = others_ >= kSamples && received - first_of_others_ <= kWindow;
      return besides ? Use::besides : Use::yes;
    }
    if (others_ == 0 || received - first_of_others_ > kWindow) {
      others_ = 0;
      first_of_others_ = received;
    }
    ++others_;
    other_ = sender;
    return Use::no;
  }
  /// "participant A, and participant B, which is left out".
  std::string describe() const {
    const std::lock_guard lock(mutex_);
    return "participant " + wire::to_string(source_.value_or(wire::ParticipantId{})) + ", and participant " +
           wire::to_string(other_) + ", which is left out";
  }

 private:
  mutable std::mutex mutex_{};
  std::optional<wire::ParticipantId> source_{};
  wire::ParticipantId other_{};
  Time heard_{}, first_of_others_{};
  int others_{};
};

}  // namespace adit::agent

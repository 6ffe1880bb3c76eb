// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/time/time.hpp"

namespace adit::perception {

/// One step of the ladder: a size, a quality and the least rate at which it is worth while.
struct Rung {
  std::uint16_t width{}, height{};  ///< The picture fits into it.
  bool colour{};
  std::uint8_t quality{};
  double least_rate{};  ///< Pictures/s at which the rung is left for the one below.
  double most_rate{};   ///< Pictures/s.
  bool operator==(const Rung&) const = default;
};

/// All steps, from the lowest.
std::span<const Rung> rungs();

/// What one camera may use.
struct LadderInput {
  double bytes_per_second{};   ///< What the link leaves to this camera, headers included.
  std::uint16_t most_width{};  ///< That someone looks at, pixels.
  double most_rate{};          ///< Pictures/s that someone looks at.
};

/// Chooses size, quality and rate of a camera's pictures by the bytes that the link leaves it: quality goes
/// first, then size, then rate. It learns the bytes of a picture on each rung from those that were coded; a
/// step up needs half as much room again for 3 s, a step down none, so that it does not swing.
///
/// The rung is chosen by the bytes of whole pictures, so that motion does not overload the link. The rate
/// follows the bytes that pictures really have, without the stripes that did not change.
class Ladder {
 public:
  struct Choice {
    Rung rung{};
    Duration period{};  ///< From one picture to the next; kNoPicture: none is wanted, or there is no room.
  };
  static constexpr Duration kNoPicture = std::chrono::hours(1);

  Ladder();
  Choice choose(const LadderInput& input, Time now);
  /// Notes the size of a coded picture with its headers; `whole`: all stripes were in it.
  void coded(const Rung& rung, std::size_t bytes, bool whole);

 private:
  static constexpr std::size_t kRungs = 11;

  double whole_bytes(std::size_t rung) const;
  /// The highest rung that the input has room for at `room` times its least rate.
  std::size_t highest(const LadderInput& input, double room) const;

  std::optional<std::size_t> rung_{};
  std::optional<Time> room_since_{};  ///< Since when there has been room for a higher rung.
  std::size_t room_for_{};            ///< The lowest rung that there was room for since.
  // Bytes of a whole picture: those expected, times what the scene makes of it, times what was learned of the
  // rung.
  double scene_{1.0};
  std::array<double, kRungs> own_{};
  std::array<int, kRungs> learned_{};   ///< Pictures from which own_ was learned.
  std::optional<std::size_t> first_{};  ///< The first rung of which there was a whole picture.
  std::optional<double> actual_{};      ///< Mean bytes of a picture on rung_.
};

}  // namespace adit::perception

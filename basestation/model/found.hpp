// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "basestation/model/outcome.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// What the operator decided about a finding.
enum class Verdict : std::uint8_t { open, confirmed, rejected };

/// How much of a finding's photo is at the station.
enum class PhotoHere : std::uint8_t { none, thumbnail, whole };

/// The photo of a finding as the station lists it.
struct FoundPhoto {
  PhotoHere here{PhotoHere::none};
  std::uint8_t percent{};  ///< Of the whole photo that is here, [0, 100].
  std::uint32_t bytes{};   ///< Of the whole photo.
  std::string id{};        ///< Hash of the whole photo, sixteen hexadecimal digits.
  bool operator==(const FoundPhoto&) const = default;
};

/// A finding as the station lists it.
struct FoundItem {
  std::uint32_t number{};  ///< By which commands name it; the station counts findings from 1.
  std::string robot{};
  std::string id{};  ///< The robot's id of it, sixteen hexadecimal digits.
  std::string kind{};
  std::uint8_t importance{};
  std::array<double, 3> position{};  ///< Map frame, m.
  std::string text{};
  std::optional<double> age{};  ///< By the robot's clock, s; unset: unknown.
  Verdict verdict{Verdict::open};
  std::string note{};                 ///< The operator's.
  bool withdrawn{false};              ///< Its robot or operator took it back.
  std::optional<FoundPhoto> photo{};  ///< Unset: it has none.
  /// Numbers of findings of other robots that are the same object; they are not listed themselves.
  std::vector<std::uint32_t> also{};
  bool mark{false};  ///< An operator marked it; `robot` is the name of his station.
  bool operator==(const FoundItem&) const = default;
};

/// How many findings a robot still stores.
struct FoundAtRobot {
  std::string robot{};
  std::uint32_t stored{};      ///< At the robot.
  std::uint32_t here{};        ///< Of that robot, at this station.
  std::uint32_t overflowed{};  ///< For which the robot had no room.
  bool operator==(const FoundAtRobot&) const = default;
};

/// The answer to `findings`.
struct FoundReport {
  std::vector<FoundItem> findings{};  ///< The most important first.
  std::vector<FoundAtRobot> at_robots{};
  bool operator==(const FoundReport&) const = default;
};

/// "open", "confirmed", "rejected".
const char* to_string(Verdict verdict);
/// "none", "thumbnail", "whole".
const char* to_string(PhotoHere here);
/// "-" without a photo, "none", "thumbnail", "thumbnail, 40 %" or "whole".
std::string photo_text(const std::optional<FoundPhoto>& photo);

/// Reads the outcome of `findings`. Errors: as of health_of().
Result<FoundReport> findings_of(const CommandOutcome& outcome);
/// The report as JSON, as `basestation --json findings` writes it, for a file.
std::string findings_text_of(const FoundReport& report);

}  // namespace adit::station

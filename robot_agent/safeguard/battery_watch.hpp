// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

namespace adit::agent {

/// Thresholds of the charge, 0..1, falling.
enum class BatteryLevel : unsigned char { good, warning, low, last };

struct BatteryParams {
  double warning{0.30};  ///< (0, 1)
  double low{0.20};      ///< Below `warning`.
  double last{0.10};     ///< Below `low`.
  double rise{0.05};  ///< Hysteresis: a threshold is left when the charge exceeds it by this much, [0, 0.5].
};

/// Detects that the charge fell below a threshold. Each threshold is reported once: neither a charge that
/// varies around it nor a restart repeats the report.
class BatteryWatch {
 public:
  explicit BatteryWatch(BatteryParams params) : params_(params) {}

  /// Restores the level after a restart.
  void restore(BatteryLevel level) { level_ = level; }
  /// Processes the charge, [0, 1]; negative or NaN: unknown. Returns the new level if the charge fell to a
  /// lower one.
  std::optional<BatteryLevel> update(double charge) {
    if (!(charge >= 0.0)) return std::nullopt;
    const BatteryLevel now = level_of(charge);
    if (now > level_) {
      level_ = now;
      return now;
    }
    if (const BatteryLevel risen = level_of(charge - params_.rise); risen < level_) level_ = risen;
    return std::nullopt;
  }
  BatteryLevel level() const { return level_; }

 private:
  BatteryLevel level_of(double charge) const {
    if (charge <= params_.last) return BatteryLevel::last;
    if (charge <= params_.low) return BatteryLevel::low;
    return charge <= params_.warning ? BatteryLevel::warning : BatteryLevel::good;
  }
  BatteryParams params_;
  BatteryLevel level_{BatteryLevel::good};
};

}  // namespace adit::agent

#pragma once
#include <array>
#include <optional>

namespace adit::agent {

/// Thresholds of the charge, 0..1, falling.
enum class BatteryLevel : unsigned char { good, warning, low, last };

struct BatteryParams {
  double warning{0.30};  ///< (0, 1)
  double low{0.20};      ///< below warning
  double last{0.10};     ///< below low
  double rise{0.05};     ///< the charge is above a threshold again when it is by so much, [0, 0.5]
};

/// Notices that the charge passed a threshold. Each is told once: a charge that wavers around one is not told
/// again and again, nor is one that a restart finds as it was.
class BatteryWatch {
 public:
  explicit BatteryWatch(BatteryParams params) : params_(params) {}

  /// After a restart.
  void restore(BatteryLevel level) { level_ = level; }
  /// `charge` 0..1; negative or not a number: not known. The level when it fell to a lower one.
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

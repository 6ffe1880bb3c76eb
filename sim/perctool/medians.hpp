// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

namespace adit::sim::perctool {

/// Collects numbers for their quantiles.
class Medians {
 public:
  void add(double value) { values_.push_back(value); }
  double median() const { return quantile(0.5); }
  /// The value below which a share of all is, [0, 1]; 0 without values.
  double quantile(double share) const {
    if (values_.empty()) return 0.0;
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
    return sorted[std::min(at, sorted.size() - 1)];
  }

 private:
  std::vector<double> values_{};
};

}  // namespace adit::sim::perctool

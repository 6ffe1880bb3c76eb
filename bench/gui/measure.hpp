// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace adit::gui::bench {

/// Steady time, ms.
double steady_ms();
/// Processor time of this process so far, ms.
double processor_ms();
/// Resident memory of this process, MB.
double resident_mb();
/// The value below which that share of the samples is; 0 without samples.
double share_below(std::vector<double> samples, double share);

/// Named results of one run, in the order of the report.
using Results = std::vector<std::pair<std::string, double>>;

}  // namespace adit::gui::bench

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/result/result.hpp"

namespace adit::agent {

/// Memory of this process, MB (2^20 bytes).
struct MemoryUse {
  double touched{};   ///< Private pages in memory or swapped out: the used part of heap and stacks.
  double reserved{};  ///< What RLIMIT_DATA counts: `touched` and reserved pages that were never used (8 MB
                      ///< for each thread's stack).
};
/// Errors: cannot_read.
Result<MemoryUse> memory_use();

/// Memory that an agent needs in addition to its use after the start, for scans, plans and peers, MB. The
/// minimum reported in errors includes a larger margin, because starts differ.
inline constexpr double kMinRoom = 12.0;
inline constexpr double kReportedRoom = 24.0;

/// The value of RLIMIT_DATA, MB, with which `limit` bounds the touched memory and all further allocations;
/// reserved pages that were never used do not count. Errors: out_of_range, with the smallest sufficient
/// limit, if `limit` leaves less than kMinRoom above the touched memory.
Result<double> data_limit(double limit, const MemoryUse& now);

/// Bounds this process from now on: allocations beyond the limit, MB, fail. 0: no limit. Call it after the
/// start, so that the memory needed by the start is measured. Errors: those of memory_use() and data_limit(),
/// cannot_write (setrlimit).
Result<void> limit_memory(double limit);

}  // namespace adit::agent

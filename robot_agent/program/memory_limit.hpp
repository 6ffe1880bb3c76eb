#pragma once
#include "core/result/result.hpp"

namespace adit::agent {

/// What this process holds, MB (2^20 bytes).
struct MemoryUse {
  double touched{};   ///< its own pages in memory or swapped out: heap and stacks as far as they were used
  double reserved{};  ///< what RLIMIT_DATA counts: the same, and what was never used of it (8 MB a thread's
                      ///< stack)
};
/// Errors: cannot_read.
Result<MemoryUse> memory_use();

/// Room that an agent needs above what it holds after its start, for scans, plans and peers, MB. What is told
/// as the least that works has more: one start is not as the other.
inline constexpr double kLeastRoom = 12.0;
inline constexpr double kToldRoom = 24.0;

/// The limit for RLIMIT_DATA, MB, so that `limit` bounds what is touched now and all that is allocated from
/// now on; what was reserved and never used does not count. Errors: out_of_range, with the least that works,
/// when there is less than kLeastRoom above what is touched.
Result<double> data_limit(double limit, const MemoryUse& now);

/// Bounds this process from now on: allocations beyond the limit fail. 0: no limit. After the start, so that
/// what a start needs is known and not guessed. Errors: of both above, cannot_write (setrlimit).
Result<void> limit_memory(double limit);

}  // namespace adit::agent

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <ctime>

namespace adit::sim::navtool {

/// CPU time of this thread, ms.
inline double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

}  // namespace adit::sim::navtool

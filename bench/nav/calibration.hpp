// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::bench {

/// CPU time of the calling thread, ms.
double thread_cpu_ms();

/// Thread-CPU milliseconds (median of 21) of a fixed piece of work of the kind planners do: voxels of 28 500
/// points hashed, a quarter of them looked up in a grid for 36 headings. One "unit": it carries a time read
/// on one machine to another.
double calibration_unit_ms();

}  // namespace adit::bench

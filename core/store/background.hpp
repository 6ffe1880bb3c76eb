// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/exec/executor.hpp"
#include "core/store/disk.hpp"

namespace adit::store {

/// Runs work on a disk beside the home strand: for a disk of a rehearsal after `spec.modelled`, else on the
/// writer's strand, or as a job if there is none. Call it on the home strand.
///
/// @param writer  Null: there is none.
/// @param back    Runs on the home strand afterwards; live, never if the writer dropped the work. Empty:
/// nothing.
/// @return The timer of a rehearsal: the work does not run once it is destroyed.
[[nodiscard]] Timer run_in_background(const Disk& disk, Executor& home,
                                      const std::shared_ptr<Executor>& writer, JobSpec spec, Task work,
                                      Task back = {});

}  // namespace adit::store

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "sim/rehearsal/program/seeds.hpp"

namespace adit::sim {

/// Shrinks the first failing seed of each rule that was broken (of at most three), prints what is left, and
/// writes each as a scenario that fails by itself: the first to `file`, when that is not empty, the others to
/// NAME-seedN-ruleM.yaml in the working folder. Ctrl-C writes what was found by then. Errors: a file that
/// cannot be written.
Result<void> shrink_seeds(const Scenario& scenario, const std::shared_ptr<const World>& world,
                          const RunParams& params, const SeedsOutcome& outcome, const std::string& file);

}  // namespace adit::sim

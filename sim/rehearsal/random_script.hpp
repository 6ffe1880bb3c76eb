// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/time/random.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::sim {

/// The verbs that `random_script: verbs` may name.
bool is_random_verb(const std::string& verb);
std::vector<std::string> all_random_verbs();

/// Draws the lines of a random script: same generator state, same lines. Sorted by time. One in four
/// lines goes to the robot of the line before, so that operators meet.
std::vector<ScriptLine> draw_script(const RandomScript& random, const Scenario& scenario, Random generator);

}  // namespace adit::sim

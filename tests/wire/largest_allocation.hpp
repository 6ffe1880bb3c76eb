// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace adit::wire {

/// The largest single allocation of this program since it was set to 0.
extern std::size_t largest_allocation;

}  // namespace adit::wire

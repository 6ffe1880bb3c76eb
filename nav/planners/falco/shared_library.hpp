// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/config/platform.hpp"

namespace adit::nav {

struct PlannerLibrary;

/// PlannerLibrary::build() with the default parameters, once per process for all platforms that need the same
/// library. For processes that start many agents; callable from any thread.
std::shared_ptr<const PlannerLibrary> shared_library(const Platform& platform);

}  // namespace adit::nav

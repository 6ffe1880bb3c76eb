// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "nav/control/controller.hpp"

namespace adit::nav {

/// Creates the default controller: model predictive control over 2.5 s of the path (50 steps of 50 ms) with
/// the motion model of the platform's drive, solved by Ilqr. A solve takes about 0.1 ms on the caller's
/// strand. Nothing is allocated after construction.
std::unique_ptr<Controller> make_ilqr_controller(const Platform& platform);

}  // namespace adit::nav

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include "core/geometry/pose.hpp"

namespace adit::agent {

/// Matches velocities that are all zero and of which there is at least one. testing::Each alone also accepts
/// a robot to which nothing was sent.
inline auto only_zero() { return testing::AllOf(testing::Not(testing::IsEmpty()), testing::Each(Twist2{})); }

}  // namespace adit::agent

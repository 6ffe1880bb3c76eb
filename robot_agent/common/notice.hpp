// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/contract/robot.hpp"

namespace adit::agent {

using contract::Severity;
/// A notification for operators. The Notifier sets the robot's name and the time.
using Notice = contract::Notification;

}  // namespace adit::agent

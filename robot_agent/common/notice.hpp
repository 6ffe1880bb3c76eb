// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "core/contract/robot.hpp"

namespace adit::agent {

using contract::Severity;
/// A notification for operators. The Notifier sets the robot's name and the time.
using Notice = contract::Notification;

/// Notifies the robot's holder, if it has one. The arguments are those of a Notice.
using NotifyHolder = std::function<void(Severity, const std::string& code, Reason, const std::string& text)>;

}  // namespace adit::agent

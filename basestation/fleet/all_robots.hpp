// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/fleet/fleet.hpp"
#include "core/command/request.hpp"
#include "core/result/result.hpp"

namespace adit::station {

/// Names the robots that the `all` of a request means now. Errors: not_holder or unknown_robot when it means
/// none.
Result<command::Request> with_robots_named(command::Request request, const Fleet& fleet);

}  // namespace adit::station

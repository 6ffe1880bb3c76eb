// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/fleet/views.hpp"
#include "core/result/result.hpp"

namespace adit::station::host {

/// The station's identity, 128 random bits that never change after its first start: read from NAME.id of the
/// state folder, and created there if missing (mode 0600, atomically). Errors: cannot_read, cannot_write,
/// malformed.
Result<Id> station_id(const std::string& name);

}  // namespace adit::station::host

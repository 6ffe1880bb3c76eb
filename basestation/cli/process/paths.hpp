// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/fleet/views.hpp"
#include "core/result/result.hpp"

/// Paths and files that a station's processes share.
namespace adit::station::cli {

/// The folder of the sockets, for this user only: $XDG_RUNTIME_DIR/adit, or /tmp/adit-UID if that is not set.
/// Created with mode 0700; refused (cannot_write) if it belongs to another user or is accessible to others.
Result<std::string> runtime_folder();
/// $XDG_STATE_HOME/adit, or ~/.local/state/adit. Created with mode 0700.
Result<std::string> state_folder();

/// The station's identity, 128 random bits that never change after its first start: read from NAME.id of the
/// state folder, and created there if missing (mode 0600, atomically). Errors: cannot_read, cannot_write,
/// malformed.
Result<Id> station_id(const std::string& name);

}  // namespace adit::station::cli

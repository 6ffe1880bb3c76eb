#pragma once
#include <string>

#include "basestation/fleet/views.hpp"
#include "core/result/result.hpp"

/// Where a station keeps what it needs between processes.
namespace adit::station::cli {

/// The folder of the sockets, for this user only: $XDG_RUNTIME_DIR/adit, or /tmp/adit-UID when that is not
/// set. Made with mode 0700; refused (cannot_write) when it is somebody else's or open to others.
Result<std::string> runtime_folder();
/// $XDG_STATE_HOME/adit, or ~/.local/state/adit. Made with mode 0700.
Result<std::string> state_folder();

/// The station's identity, 128 random bits that stay the same from its first start on: read from NAME.id of
/// the state folder, made there when missing (mode 0600, atomically). Errors: cannot_read, cannot_write,
/// malformed.
Result<Id> station_id(const std::string& name);

}  // namespace adit::station::cli

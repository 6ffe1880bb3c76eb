// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/result/result.hpp"

/// Paths and files that a station's processes share.
namespace adit::station::client {

/// The folder of the sockets, for this user only: $XDG_RUNTIME_DIR/adit, or /tmp/adit-UID if that is not set.
/// Created with mode 0700; refused (cannot_write) if it belongs to another user or is accessible to others.
Result<std::string> runtime_folder();
/// $XDG_STATE_HOME/adit, or ~/.local/state/adit. Created with mode 0700.
Result<std::string> state_folder();
/// Path of the socket of that operator's station. Error: cannot_write.
Result<std::string> socket_path(const std::string& name);

}  // namespace adit::station::client

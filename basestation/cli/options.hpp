// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/client/options.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::station::cli {

/// The options before the command on the command line.
struct Options : client::StationOptions {
  bool json{false};   ///< One JSON object in place of text.
  bool alone{false};  ///< A stop does not ask the station: the caller did, and it hangs.
};

}  // namespace adit::station::cli

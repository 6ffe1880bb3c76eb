// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>

#include "basestation/client/options.hpp"
#include "core/result/result.hpp"

namespace adit::station::client {

/// The options of every front end's command line: which station, and its network if it has to be started.
class StationArguments {
 public:
  StationArguments(CLI::App& app, StationOptions& options);
  /// To be called after parsing. Error: bad_argument, a name that no operator can have.
  Result<void> finish();

 private:
  StationOptions& options_;
  CLI::Option* domain_{};
};

}  // namespace adit::station::client

#pragma once
#include "basestation/cli/client.hpp"

namespace adit::station::cli {

/// The live dashboard: redraws five times a second, takes keys until q or Ctrl-C. The exit code.
int watch(Client& client, const Options& options);

}  // namespace adit::station::cli

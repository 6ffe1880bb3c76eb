#pragma once
#include "basestation/cli/options.hpp"

namespace adit::station::cli {

/// `stop`: by the station when it takes the command within 300 ms, else by a participant of this very process
/// with the same name and identity. The exit code.
int stop(const Options& options, const std::string& line, bool all);

}  // namespace adit::station::cli

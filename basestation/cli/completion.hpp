// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/cli/options.hpp"

namespace adit::station::cli {

/// `completion bash|zsh|fish`: prints the shell's script. The hidden form `completion words WORD...` prints
/// the possible next words, one per line; the scripts call it, so that the names of robots are also
/// completed.
int print_completion(const Options& options, const std::vector<std::string>& words);

/// The possible completions of `words` (the last one is incomplete): commands, modes, options, and `robots`.
std::vector<std::string> candidates(const std::vector<std::string>& words,
                                    const std::vector<std::string>& robots);

}  // namespace adit::station::cli

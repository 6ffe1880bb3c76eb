#pragma once
#include <string>
#include <vector>

#include "basestation/cli/options.hpp"

namespace adit::station::cli {

/// `completion bash|zsh|fish`: prints the shell's script. Hidden: `completion words WORD...` prints what may
/// follow these words, one a line; the scripts ask it, so that robots' names are there as well.
int print_completion(const Options& options, const std::vector<std::string>& words);

/// What may follow `words` (the last one is being typed): commands, modes, options, and `robots`.
std::vector<std::string> candidates(const std::vector<std::string>& words,
                                    const std::vector<std::string>& robots);

}  // namespace adit::station::cli

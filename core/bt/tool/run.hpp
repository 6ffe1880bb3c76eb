// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace adit::bt::tool {

struct RunOptions {
  std::string file{};
  std::string leaves{};  ///< Path of LEAVES.yaml; empty: every leaf succeeds.
  std::string tree{};    ///< ID of the tree; empty: the file's main tree.
  int ticks{10};         ///< Number of ticks, 1 to 1 000 000.
  int tick_ms{10};       ///< Virtual time between ticks, ms, 0 to 3 600 000.
  bool json{false};
};

/// Does a dry run and prints one line per tick. Returns the program's exit status.
int run(const RunOptions& options);

}  // namespace adit::bt::tool

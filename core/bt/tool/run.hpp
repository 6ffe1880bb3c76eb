#pragma once
#include <string>

namespace adit::bt::tool {

struct RunOptions {
  std::string file{};
  std::string leaves{};  ///< LEAVES.yaml; none: every leaf succeeds
  std::string tree{};    ///< ID of the tree; none: the file's main tree
  int ticks{10};         ///< 1 to 1 000 000
  int tick_ms{10};       ///< virtual time between ticks [ms], 0 to 3 600 000
  bool json{false};
};

/// A dry run, printed one line a tick. The program's exit status.
int run(const RunOptions& options);

}  // namespace adit::bt::tool

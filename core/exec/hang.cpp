#include "core/exec/hang.hpp"

#include <exception>

namespace adit {

void hang(Executor& strand) {
  strand.block();
  std::terminate();
}

}  // namespace adit

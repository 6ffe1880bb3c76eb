// SPDX-License-Identifier: Apache-2.0
#include "core/exec/fault.hpp"

#include <exception>
#include <stdexcept>

namespace adit {

void hang(Executor& strand) {
  auto* blocked = dynamic_cast<CanHang*>(&strand);
  if (!blocked) throw std::logic_error("only the task of a runtime's strand can hang");
  blocked->block();
  std::terminate();
}

}  // namespace adit

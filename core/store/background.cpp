// SPDX-License-Identifier: Apache-2.0
#include "core/store/background.hpp"

#include <utility>

namespace adit::store {

Timer run_in_background(const Disk& disk, Executor& home, const std::shared_ptr<Executor>& writer,
                        JobSpec spec, Task work, Task back) {
  if (disk.instant())
    return home.after(spec.modelled, [work = std::move(work), back = std::move(back)] {
      work();
      if (back) back();
    });
  if (writer) {
    writer->post([work = std::move(work), back = std::move(back), inbox = home.inbox()] {
      work();
      if (back) inbox->post_control(back);
    });
    return {};
  }
  home.compute(std::move(spec), std::move(work), [back = std::move(back)](const Result<void>&) {
    if (back) back();
  });
  return {};
}

}  // namespace adit::store

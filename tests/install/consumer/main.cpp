// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "core/config/platform_file.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "nav/local_navigation.hpp"

int main() {
  adit::VirtualScheduler scheduler(1);
  scheduler.run_until(adit::Duration(5));
  const auto platform = adit::config::load_platform("legged");
  if (!platform) std::fprintf(stderr, "%s\n", platform.error().text.c_str());
  if (platform && adit::nav::LocalNavigation(*platform).map()) return 1;
  return platform && platform->stairs && scheduler.elapsed() == adit::Duration(5) ? 0 : 1;
}

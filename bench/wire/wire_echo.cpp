// SPDX-License-Identifier: Apache-2.0
// The other process of bench_wire_latency and of the live tests: echoes until its input closes or it is
// killed.
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "bench/wire/echo.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: wire_echo DOMAIN\n");
    return 2;
  }
  const adit::bench::Echo echo(static_cast<unsigned>(std::atoi(argv[1])));
  std::printf("ready\n");
  std::fflush(stdout);
  pause();
}

// SPDX-License-Identifier: Apache-2.0
// One robot or station of a fleet at rest, without its program: for the live tests of discovery. It prints
// the peers that it has heard until it is killed.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <set>

#include "bench/wire/idle.hpp"

namespace {

struct Net {
  unsigned domain;
  std::string interface;
  adit::LiveRuntime runtime{};
  std::unique_ptr<adit::wire::Participant> join(const std::string& name) {
    return std::move(adit::wire::open_fastdds({.domain = domain, .name = name, .interfaces = {interface}}))
        .value();
  }
  std::shared_ptr<adit::Executor> strand(const std::string& name) { return runtime.strand(name); }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: wire_member DOMAIN INTERFACE robot|station NAME\n");
    return 2;
  }
  Net net{static_cast<unsigned>(std::atoi(argv[1])), argv[2]};
  const std::string kind = argv[3], name = argv[4];
  std::set<std::string> known;
  const auto heard = [&](const adit::radio::Capabilities& sample) {
    const std::string who = sample.name() + "@" + sample.software();
    if (!known.insert(who).second) return;
    std::printf("heard %s\n", who.c_str());
    std::fflush(stdout);
  };
  const auto idle = kind == "robot" ? adit::bench::robot(net, name, heard, argv[2])
                                    : adit::bench::station(net, name, 3, heard, argv[2]);
  std::printf("ready\n");
  std::fflush(stdout);
  pause();
}

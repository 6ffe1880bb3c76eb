// SPDX-License-Identifier: Apache-2.0
// A real radio without a link profile: what the sockets refuse is counted, and waits by priority.
#include <gtest/gtest.h>
#include <sched.h>

#include <cstdlib>
#include <thread>

#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/fastdds/link_shaper.hpp"
#include "core/wire/link/rate_control.hpp"
#include "tests/live/process.hpp"

namespace adit::wire {
namespace {

/// Runs the body on a thread in a network of its own, whose only interface, 10.79.0.1, sends 8 kbit/s.
void on_a_thin_radio(const std::function<void()>& body) {
  std::string missing;
  std::thread thread([&] {
    if (::unshare(CLONE_NEWNET) != 0) {
      missing = "no network namespaces here";
      return;
    }
    std::string commands =
        "ip link set lo up && ip link add r0 type veth peer name r1 && ip addr add 10.79.0.1/24 dev r0 && "
        "ip link set r0 up && ip link set r1 up && "
        "tc qdisc add dev r0 root tbf rate 8kbit burst 2kb limit 3kb";
    for (const char* peer : {"2", "3", "4"})
      commands +=
          std::string(" && ip neigh add 10.79.0.") + peer + " lladdr 02:00:00:00:00:0" + peer + " dev r0";
    const int made = std::system(commands.c_str());
    if (made != 0) {
      missing = "no pair of interfaces with a token bucket here";
      return;
    }
    body();
  });
  thread.join();
  if (!missing.empty()) GTEST_SKIP() << missing;
}

TEST(Radio, SenderStateShowsDatagramsRefusedByTheSocket) {
  on_a_thin_radio([] {
    auto wire = open_fastdds({.domain = live::domain(),
                              .interfaces = {"10.79.0.1"},
                              .peers = {"10.79.0.2", "10.79.0.3", "10.79.0.4"}});
    ASSERT_TRUE(wire) << wire.error().text;
    // The announcements of discovery alone are more than the radio takes.
    RateControl rate;
    Time now{};
    const bool slowed = live::eventually(
        [&] {
          const SenderState sender = (*wire)->sender();
          rate.observe(now += 20ms, sender.waiting(kStatusPriority), sender.lost(kStatusPriority));
          return rate.rate() < 10.0;
        },
        live::Seconds(8));
    EXPECT_TRUE(slowed);
    EXPECT_EQ((*wire)->sender().link, nullptr);
  });
}

}  // namespace
}  // namespace adit::wire

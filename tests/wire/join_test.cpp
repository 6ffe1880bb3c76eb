// SPDX-License-Identifier: Apache-2.0
// Members that come, die and come back elsewhere, each a process over Fast DDS: heard by all within 3 s.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "tests/folders/folders.hpp"
#include "tests/live/process.hpp"

namespace adit::live {
namespace {

constexpr Seconds limit(3);
using SteadyClock = std::chrono::steady_clock;

class Fleet {
 public:
  struct Member {
    std::string name{}, address{};
    std::unique_ptr<Process> process{};
  };

  /// `machine`: nothing, or the process whose network it uses.
  void start(const std::string& kind, const std::string& name, const std::string& address = "127.0.0.1",
             const Process* machine = nullptr) {
    std::vector<std::string> command{"wire_member", std::to_string(domain()), address, kind, name};
    if (machine != nullptr) {
      command[0] = program_folder() + "/wire_member";
      const std::vector<std::string> enter{"/usr/bin/nsenter", "-t", std::to_string(machine->pid()), "-n"};
      command.insert(command.begin(), enter.begin(), enter.end());
    }
    members_.push_back({name, address, std::make_unique<Process>(std::move(command))});
    started_ = SteadyClock::now();
  }
  void kill_last() {
    members_.back().process->signal(SIGKILL);
    members_.back().process->wait(Seconds(5));
    members_.pop_back();
  }
  /// Until all have heard all; the time since the last start, or more than `give_up` when that is over.
  Seconds complete(Seconds give_up = Seconds(12)) {
    for (const Member& a : members_) {
      for (const Member& b : members_) {
        if (&a == &b) continue;
        const Seconds left = give_up - (SteadyClock::now() - started_);
        if (!a.process->wait_for_output("heard " + b.name + "@" + b.address + "\n", left)) {
          std::printf("%s had not heard %s\n", a.name.c_str(), b.name.c_str());
          return Seconds(SteadyClock::now() - started_);
        }
      }
    }
    return SteadyClock::now() - started_;
  }

 private:
  std::vector<Member> members_{};
  SteadyClock::time_point started_{};
};

TEST(LiveJoin, TwentyMembersComeToFourAndEachIsHeardByAll) {
  Fleet fleet;
  fleet.start("robot", "r0");
  fleet.start("robot", "r1");
  fleet.start("robot", "r2");
  fleet.start("station", "op0");
  EXPECT_LT(fleet.complete(), limit * patience());
  Seconds shortest = Seconds::max();  // on a busy machine it has to be within the limit too
  for (int i = 0; i < 20; ++i) {
    fleet.start(i % 2 == 0 ? "station" : "robot", "new" + std::to_string(i));
    const Seconds time = fleet.complete();
    std::printf("join %d: %.3f s\n", i, time.count());
    EXPECT_LT(time, limit * patience()) << "join " << i;
    shortest = std::min(shortest, time);
    fleet.kill_last();
  }
  EXPECT_LT(shortest, limit);
}

/// Two machines with a cable between them: network namespaces, each held by a process.
class TwoMachines {
 public:
  /// Empty, or why that is not possible here.
  std::string connect() {
    for (const Process* machine : {&left, &right}) {
      const auto of = [](const std::string& pid) {
        return std::filesystem::read_symlink("/proc/" + pid + "/ns/net");
      };
      std::error_code gone;
      const auto separate = [&] {
        return std::filesystem::exists("/proc/" + std::to_string(machine->pid()), gone) &&
               of(std::to_string(machine->pid())) != of("self");
      };
      if (!eventually(separate, Seconds(2))) return "no network namespaces here";
    }
    const std::string r = std::to_string(right.pid());
    const std::string commands[] = {"link add va type veth peer name vb netns " + r,
                                    "addr add 10.77.0.1/24 dev va", "link set va up", "link set lo up"};
    const std::string there[] = {"addr add 10.77.0.2/24 dev vb", "addr add 10.77.0.3/24 dev vb",
                                 "link set vb up", "link set lo up"};
    for (const std::string& command : commands) {
      if (!ip(left, command)) return "ip " + command + " failed";
    }
    for (const std::string& command : there) {
      if (!ip(right, command)) return "ip " + command + " failed";
    }
    const auto up = [&] {
      return ip(left, "link show va | grep -q LOWER_UP") && ip(right, "link show vb | grep -q LOWER_UP");
    };
    return eventually(up, Seconds(5)) ? "" : "the link does not come up";
  }

  Process left{{"/usr/bin/unshare", "-n", "/usr/bin/sleep", "infinity"}};
  Process right{{"/usr/bin/unshare", "-n", "/usr/bin/sleep", "infinity"}};

 private:
  static bool ip(const Process& machine, const std::string& command) {
    const std::string enter =
        "exec /usr/bin/nsenter -t " + std::to_string(machine.pid()) + " -n ip " + command;
    return run({"/bin/sh", "-c", enter}).exit_code == 0;
  }
};

TEST(LiveJoin, AKilledMemberIsHeardAgainAtAnotherAddress) {
  TwoMachines machines;
  if (const std::string why = machines.connect(); !why.empty()) GTEST_SKIP() << why;
  Fleet fleet;
  fleet.start("robot", "r0", "10.77.0.1", &machines.left);
  fleet.start("station", "op0", "10.77.0.1", &machines.left);
  fleet.start("robot", "r1", "10.77.0.2", &machines.right);
  EXPECT_LT(fleet.complete(), limit * patience());
  Seconds shortest = Seconds::max();
  for (const char* address : {"10.77.0.3", "10.77.0.2", "10.77.0.3"}) {
    fleet.kill_last();
    fleet.start("robot", "r1", address, &machines.right);
    const Seconds time = fleet.complete();
    std::printf("back at %s: %.3f s\n", address, time.count());
    EXPECT_LT(time, limit * patience()) << address;
    shortest = std::min(shortest, time);
  }
  EXPECT_LT(shortest, limit);
}

}  // namespace
}  // namespace adit::live

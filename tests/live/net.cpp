// SPDX-License-Identifier: Apache-2.0
#include "tests/live/net.hpp"

#include <future>
#include <map>

#include "core/exec/live_runtime.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "tests/live/process.hpp"

namespace adit::live {
namespace {

constexpr std::uint32_t kRadioDomain = 77, kRobotDomain = 100;

class RehearsalNet : public Net {
 public:
  RehearsalNet(const wire::LinkProfile& link, Duration inner)
      : network_(scheduler_, {.link = link, .inner_latency = inner}) {}

  Runtime& machine(const std::string& name) override {
    auto& machine = machines_[name];
    // Clocks of different machines are not synchronised.
    if (!machine) machine = scheduler_.machine(name, std::chrono::seconds(1000 * machines_.size()));
    return *machine;
  }
  std::unique_ptr<wire::Participant> join_radio(const std::string& machine) override {
    return network_.join(kRadioDomain, machine);
  }
  std::unique_ptr<wire::Participant> join_robot(const std::string& machine) override {
    return network_.join(kRobotDomain, machine);
  }
  void silence(const std::string& machine) override { network_.crash(machine); }
  void on(Executor&, const std::function<void()>& work) override { work(); }
  Duration clock() const override { return scheduler_.elapsed(); }
  bool until(const std::function<bool()>& condition, Duration limit) override {
    const Duration end = scheduler_.elapsed() + limit;
    while (!condition()) {
      if (scheduler_.elapsed() >= end) return false;
      scheduler_.run_until(scheduler_.elapsed() + std::chrono::milliseconds(1));
    }
    return true;
  }
  void pass(Duration time) override { scheduler_.run_until(scheduler_.elapsed() + time); }

 private:
  VirtualScheduler scheduler_{1};
  wire::SimulatedNetwork network_;
  std::map<std::string, std::unique_ptr<Runtime>> machines_{};
};

class LiveNet : public Net {
 public:
  explicit LiveNet(std::optional<wire::LinkProfile> link) : link_(std::move(link)) {}
  Runtime& machine(const std::string& name) override {
    auto& machine = machines_[name];
    if (!machine) machine = std::make_unique<LiveRuntime>();
    return *machine;
  }
  std::unique_ptr<wire::Participant> join_radio(const std::string& machine) override {
    return join({.domain = domain(0), .name = machine, .link = link_, .link_seed = ++seed_});
  }
  std::unique_ptr<wire::Participant> join_robot(const std::string& machine) override {
    return join({.domain = domain(1), .name = machine});
  }
  void silence(const std::string&) override {}
  Duration clock() const override { return std::chrono::steady_clock::now().time_since_epoch(); }
  void on(Executor& strand, const std::function<void()>& work) override {
    std::promise<void> done;
    strand.post([&] {
      work();
      done.set_value();
    });
    done.get_future().wait();
  }
  bool until(const std::function<bool()>& condition, Duration limit) override {
    return eventually(condition, Seconds(limit));
  }
  void pass(Duration time) override { live::pass(Seconds(time)); }

 private:
  static std::unique_ptr<wire::Participant> join(const wire::FastDdsParams& params) {
    auto wire = wire::open_fastdds(params);
    if (!wire) throw std::runtime_error(wire.error().text);
    return std::move(*wire);
  }

  std::optional<wire::LinkProfile> link_;
  std::uint64_t seed_{};
  std::map<std::string, std::unique_ptr<LiveRuntime>> machines_{};
};

}  // namespace

std::unique_ptr<Net> make_rehearsal_net(const wire::LinkProfile& link, Duration inner) {
  return std::make_unique<RehearsalNet>(link, inner);
}
std::unique_ptr<Net> make_live_net(std::optional<wire::LinkProfile> link) {
  return std::make_unique<LiveNet>(std::move(link));
}

}  // namespace adit::live

// SPDX-License-Identifier: Apache-2.0
// Who is there, as an agent itself knows it: every change is in its published list within 3 s.
#include <gmock/gmock.h>

#include "core/wire/component_io.hpp"
#include "robot_agent/radio/radio_edge.hpp"
#include "tests/agent/fake_requests.hpp"
#include "tests/live/crew.hpp"

namespace adit::live {
namespace {

using namespace std::chrono_literals;

/// What of an agent speaks and listens on the radio, with nothing behind it.
class Member {
 public:
  Member(Net& net, const std::string& name)
      : net_(net), strand_(net.machine(name).strand("command")), wire_(net.join_radio(name)) {
    net_.on(*strand_, [&] {
      edge_ = agent::RadioEdge::open({*wire_, *strand_}, name).value();
      seen_ = peers_.follow(
          *strand_, [this](const auto& list) { list_.use([&](agent::PeerList& copy) { copy = *list; }); });
      agent::RadioEdge::Dependencies parts{directory_, namesakes_,
                                           [this](const auto& work) { work(commands_); },
                                           [](const Task& task) { task(); }};
      if (!edge_->listen(std::move(parts))) throw std::runtime_error("the radio cannot be heard");
      timer_ = strand_->every(100ms, [this] { directory_.tick(strand_->now()); });
    });
  }
  ~Member() { end(); }
  void say(const std::string& platform, const station::Id& id) {
    net_.on(*strand_, [&] {
      Platform said{};
      said.name = platform;
      edge_->send_capabilities(said, id, agent::kProtocolVersion);
    });
  }
  /// Falls silent without a goodbye: the participant stays.
  void end() {
    if (!edge_) return;
    edge_->close();
    net_.on(*strand_, [&] {
      timer_.cancel();
      seen_.cancel();
      edge_.reset();
    });
  }
  /// True when the list holds that agent, present or not, with that platform.
  bool lists(const std::string& name, bool present, const std::string& platform) const {
    for (const agent::Peer& record : list_.get())
      if (record.name == name) return record.present == present && record.platform == platform;
    return false;
  }

 private:
  Net& net_;
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> wire_;
  agent::FakeRequests requests_{};
  agent::CommandInterface commands_{{.robot = "watcher"}, requests_, {[](const auto&) {}, [] {}}};
  agent::PeerTable peers_{*strand_};
  agent::Directory directory_{peers_};
  agent::Namesakes namesakes_{wire_->id()};
  Shared<agent::PeerList> list_{};
  std::unique_ptr<agent::RadioEdge> edge_{};
  Subscription seen_{};
  Timer timer_{};
};

void follows(Net& net) {
  Member watcher(net, "watcher");
  auto robot = std::make_unique<Member>(net, "r2");
  robot->say("wheeled", id_of("r2"));
  EXPECT_TRUE(net.until([&] { return watcher.lists("r2", true, "wheeled"); }, 3s)) << "appears";
  robot->say("tracked", id_of("r2"));
  EXPECT_TRUE(net.until([&] { return watcher.lists("r2", true, "tracked"); }, 3s)) << "can do other things";
  net.pass(1200ms);
  EXPECT_TRUE(watcher.lists("r2", true, "tracked"));
  net.silence("r2");
  robot->end();
  EXPECT_TRUE(net.until([&] { return watcher.lists("r2", false, "tracked"); }, 3s)) << "falls silent";
  Member back(net, "r2");  // another participant is another port: another address
  back.say("legged", id_of("r2"));
  EXPECT_TRUE(net.until([&] { return watcher.lists("r2", true, "legged"); }, 3s)) << "returns";
  net.pass(3s);
  EXPECT_TRUE(watcher.lists("r2", true, "legged")) << "and stays";

  Operator op(net, "op1");
  EXPECT_TRUE(net.until([&] { return watcher.lists("op1", true, ""); }, 3s));
  op.kill();
  EXPECT_TRUE(net.until([&] { return watcher.lists("op1", false, ""); }, 3s));
  op.start();
  EXPECT_TRUE(net.until([&] { return watcher.lists("op1", true, ""); }, 3s));
}

TEST(AgentsDirectory, FollowsWithinThreeSecondsInRehearsal) { follows(*make_rehearsal_net()); }
TEST(AgentsDirectory, FollowsWithinThreeSecondsLive) { follows(*make_live_net()); }

}  // namespace
}  // namespace adit::live

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <map>
#include <sstream>

#include "tests/authority_cases.hpp"
#include "tests/live/crew.hpp"

/// Plays the cases of authority over the wire: an agent and three stations as they are, on either net.
namespace adit::live {

using namespace std::chrono_literals;
using authority_cases::Case;
using authority_cases::Line;
using authority_cases::Told;
using testing::UnorderedElementsAreArray;

/// "take" -> "take r1", "goto 1 0" -> "goto r1 1 0"
inline std::string with_robot(const std::string& line) {
  const auto space = line.find(' ');
  return line.substr(0, space) + " r1" + (space == std::string::npos ? "" : line.substr(space));
}

inline radio::Command as_command(const std::string& line) {
  static const std::map<std::string, radio::CommandKind> kinds{{"take", radio::CMD_TAKE},
                                                               {"release", radio::CMD_RELEASE},
                                                               {"mode", radio::CMD_MODE},
                                                               {"stop", radio::CMD_STOP}};
  std::istringstream words(line);
  std::string verb, text;
  words >> verb >> text;
  radio::Command command;
  command.kind(kinds.at(verb));
  if (!text.empty()) command.words({text});
  return command;
}

struct Answered {
  std::string reason{};
  std::string holder{};
};

class Table {
 public:
  /// `lease`: the lock lease used; waits of the cases are shortened with it where that changes nothing.
  Table(std::unique_ptr<Net> net, Duration lease)
      : net_(std::move(net)),
        lease_(lease),
        robot_(*net_, params(lease)),
        observer_(*net_, "observer", "r1") {
    for (const char* name : {"op1", "op2", "op3"})
      operators_.emplace(name, std::make_unique<Operator>(*net_, name));
  }

  void play(const Case& c) {
    SCOPED_TRACE(c.name);
    ASSERT_NO_FATAL_FAILURE(begin());
    for (const Line& line : c.given) ASSERT_NO_FATAL_FAILURE(given(line));
    settle();
    observer_.forget();
    const Answered answer = say(c.asked);
    EXPECT_EQ(answer.reason, name(c.reason));
    EXPECT_EQ(answer.holder, c.holder) << "the answer names who holds";
    EXPECT_TRUE(net_->until([&] { return observer_.notices().size() >= c.told.size(); }, 3s))
        << "not everybody was told";
    settle();
    const auto status = observer_.authority();
    EXPECT_EQ(status.holder(), c.holder);
    EXPECT_EQ(status.locked(), c.locked);
    std::vector<std::string> stops;
    for (const auto& stop : status.stops()) stops.push_back(stop.station());
    EXPECT_THAT(stops, UnorderedElementsAreArray(c.stops));
    std::vector<std::string> told, expected;
    for (const auto& notice : observer_.notices())
      told.push_back(notice.operator_name() + " " + notice.code());
    for (const Told& each : c.told) expected.push_back(each.operator_name + " " + each.code);
    EXPECT_THAT(told, UnorderedElementsAreArray(expected));
  }

 private:
  static agent::AgentParams params(Duration lease) {
    agent::AgentParams p{};
    p.lock_lease = lease;
    return p;
  }

  /// A robot that remembers nothing, and has heard every station.
  void begin() {
    for (auto& [name, station] : operators_)
      if (!station->up()) station->start();
    foreigners_.clear();
    const auto before = observer_.authority().epoch().start();
    robot_.restart();
    ASSERT_TRUE(net_->until([&] { return observer_.authority().epoch().start() != before; }));
    settle();
    for (auto& [name, station] : operators_) ASSERT_EQ(say({name, "release"}).reason, "nobody_holds") << name;
  }

  /// Lets everything under way arrive: until every station knows what the robot said last.
  void settle() {
    net_->pass(100ms);
    const auto known = [&] {
      const auto status = observer_.authority();
      for (auto& [name, station] : operators_) {
        if (!station->up()) continue;
        const auto view = station->view("r1");
        if (view.epoch.start != status.epoch().start() || view.epoch.counter != status.epoch().counter() ||
            view.stops.size() != status.stops().size() || view.locked != status.locked())
          return false;
      }
      return true;
    };
    EXPECT_TRUE(net_->until(known, 5s)) << "a station does not know who holds the robot";
  }

  void given(const Line& line) {
    if (!line.by.empty()) {
      EXPECT_EQ(say(line).reason, "none") << line.by << " " << line.line;
      settle();
    } else if (line.line.starts_with("kill ")) {
      operators_.at(line.line.substr(5))->kill();
    } else if (line.line.starts_with("start ")) {
      operators_.at(line.line.substr(6))->start();
    } else {
      ASSERT_TRUE(line.line.starts_with("wait ")) << line.line;
      net_->pass(scaled(std::chrono::seconds(std::stoi(line.line.substr(5)))));
    }
  }

  /// With a shorter lease waits that are to outlast the name (3 s) or the lease still do.
  Duration scaled(Duration wait) const {
    const Duration full = std::chrono::seconds(authority_cases::kLease);
    return std::max(std::min<Duration>(wait, 4s),
                    from_seconds(seconds(wait) * seconds(lease_) / seconds(full)));
  }

  Answered say(const Line& line) {
    if (line.by.find(':') == std::string::npos) {
      const auto outcome = operators_.at(line.by)->ask(with_robot(line.line));
      const auto& result = outcome.json.at("results").at(0);
      EXPECT_EQ(outcome.exit_code, result.at("accepted").get<bool>() ? 0 : 1) << outcome.error;
      EXPECT_NE(result.at("accepted").get<bool>(), !outcome.error.empty());
      return {result.at("reason"), result.at("holder")};
    }
    // "forger:op1" has op1's id, "impostor:op1" its own; both write no presence.
    const std::string name = line.by.substr(line.by.find(':') + 1);
    auto& foreigner = foreigners_[line.by];
    if (!foreigner) foreigner = std::make_unique<Foreigner>(*net_, "foreigner", "r1");
    EXPECT_TRUE(net_->until([&] {
      return foreigner->matched() && foreigner->authority().epoch() == observer_.authority().epoch();
    }));
    radio::Command command = as_command(line.line);
    command.station(name);
    command.station_id(id_of(line.by.starts_with("forger:") ? name : line.by));
    const auto answer = foreigner->ask(command);
    if (!answer) return {"no_answer", ""};
    EXPECT_TRUE(answer->accepted() || !answer->text().empty());
    return {std::string(adit::name(static_cast<Reason>(answer->reason()))), answer->holder()};
  }

  std::unique_ptr<Net> net_;
  Duration lease_;
  Robot robot_;
  Foreigner observer_;
  std::map<std::string, std::unique_ptr<Operator>> operators_{};
  std::map<std::string, std::unique_ptr<Foreigner>> foreigners_{};
};

}  // namespace adit::live

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "sim/checker/checker.hpp"

namespace adit::sim {

inline wire::ParticipantId participant(int n) { return {static_cast<std::uint8_t>(n)}; }
inline StationId station_id(int n) { return {static_cast<std::uint8_t>(n)}; }

/// Plays a made-up record of one robot, r1, to a checker. A healthy agent: zero to the driver 20 times a
/// second, a state 10 times a second; op1 and op2 (participants and ids 1 and 2) are heard once a second.
class Record {
 public:
  Record() : checker_({{"r1", 1.5, 3.0, 20.0, 0.6, 0.5, true}}) {
    see(AgentStarted{participant(100)});
    see(VelocitySent{});
    see(ScanHeard{});
    publish();
    behave("hold");
    hear_stations();
  }

  void see(Event event) { checker_.observe("r1", now, std::move(event)); }

  /// Lets time pass; the agent sends `velocity` all the while, op1 streams `stick` when given.
  void pass(Duration how_long, Twist2 velocity = {}, const Twist2* stick = nullptr) {
    const Duration end = now + how_long;
    while (now < end) {
      now += 10ms;
      if (now % 100ms == 0ns) see(state());
      if (now % 100ms == 0ns && seeing) see(ScanHeard{});
      if (now % 1s == 0ns && stations) hear_stations();
      if (stick && now % 50ms == 0ns) push(1, *stick);
      if (now % 50ms == 0ns && driven) see(VelocitySent{velocity});
      if (now % 20ms == 0ns) {
        see(Motion{pose, moving});
        checker_.advance(now);
      }
    }
  }

  /// What the robot says of its place.
  StateSent state() const {
    const Pose2 said{pose.x + error.x(), pose.y + error.y(), pose.yaw};
    return {static_cast<std::uint64_t>(now.count()), Pose3::level(said, 0.0), sigma, localisation};
  }
  void hear_stations() {
    for (int n : {1, 2}) see(PresenceHeard{participant(n), "op" + std::to_string(n), station_id(n)});
  }
  void push(int from, Twist2 stick) {
    const Duration stamp = now / 100ms * 100ms - 100ms;
    see(JoystickHeard{participant(from), station_id(from), start, epoch, ++sequence,
                      static_cast<std::uint64_t>(stamp.count()), stick});
  }
  /// The command reaches the robot; returns it, for the answer.
  CommandHeard ask(int from, Verb verb, const std::string& text = {}, bool flag = false) {
    CommandHeard c{participant(from),
                   "op" + std::to_string(from),
                   station_id(from),
                   start,
                   epoch,
                   ++sequence,
                   verb,
                   text,
                   flag,
                   {}};
    see(c);
    return c;
  }
  void answer(const CommandHeard& c, Reason reason = Reason::none) {
    see(AckSent{c.station, c.id, c.seq, reason == Reason::none, reason, reason == Reason::none ? "" : "no",
                authority.holder, start, epoch});
  }
  /// An accepted command, with what it changes in `authority` and `epoch` done by the caller before.
  void publish() {
    authority.start = start;
    authority.counter = epoch;
    see(AuthoritySent{authority, stops});
  }
  void behave(const std::string& mode, bool stopped = false) { see(BehaviourSent{mode, stopped}); }

  void take(int by) {
    const std::string before = authority.holder;
    const CommandHeard c = ask(by, Verb::take);
    authority.holder = c.station;
    authority.holder_id = c.id;
    authority.locked = false;
    ++epoch;
    answer(c);
    publish();
    if (!before.empty()) see(NotificationSent{"taken", before, ++sequence});
    pass(20ms);
  }
  void lock(int by) {
    const CommandHeard c = ask(by, Verb::lock);
    authority.locked = true;
    answer(c);
    publish();
    pass(20ms);
  }
  void enter(const std::string& mode) {
    const CommandHeard c = ask(1, Verb::mode, mode);
    answer(c);
    behave(mode);
    pass(20ms);
  }

  /// The numbers of the rules that were broken, each once.
  std::vector<int> broken() {
    checker_.advance(now + 1ns);
    std::vector<int> out;
    for (const int rule : Checker::kNumbers)
      if (checker_.count(rule) > 0) out.push_back(rule);
    return out;
  }
  std::string texts() const {
    std::string out;
    for (const Violation& v : checker_.violations()) out += v.text + "\n";
    return out;
  }

  Duration now{};
  std::uint32_t epoch{1};
  std::uint64_t sequence{};
  Authority authority{};
  std::vector<Latch> stops{};
  Twist2 moving{};
  Pose2 pose{};                 ///< The true one.
  Eigen::Vector2d error{0, 0};  ///< Of what the robot says, m.
  double sigma{};               ///< As it says, m.
  Localisation localisation{Localisation::off};
  bool driven{true};
  bool stations{true};
  bool seeing{true};       ///< Its lidar gives scans.
  std::uint64_t start{9};  ///< Start id of the epoch.

 private:
  Checker checker_;
};

inline constexpr Twist2 kStill{};
inline constexpr Twist2 kForward{0.5, 0.0, 0.0};

}  // namespace adit::sim

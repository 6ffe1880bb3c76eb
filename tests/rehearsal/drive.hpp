// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rehearsal/record.hpp"

namespace adit::sim {

/// op1 holds the robot and drives it by joystick.
inline void drive(Record& r) {
  r.pass(1s);
  r.take(1);
  r.pass(200ms, kStill, &kStill);
  r.enter("manual");
  r.pass(100ms, kStill, &kStill);
  r.pass(500ms, kForward, &kForward);
}

inline void stop(Record& r, int by) {
  const CommandHeard c = r.ask(by, Verb::stop);
  r.stops.push_back({c.station, c.id});
  r.answer(c);
  r.behave("hold", true);
  r.publish();
}

}  // namespace adit::sim

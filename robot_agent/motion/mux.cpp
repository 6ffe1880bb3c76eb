// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/mux.hpp"

namespace adit::agent {

Mux::Output Mux::connect(std::string name, Duration max_age) {
  inputs_.push_back({std::move(name), max_age, Stand{}, false, Time{}});
  return {this, inputs_.size() - 1};
}

void Mux::enable(std::string_view name, Time now) {
  std::size_t next = kNone;
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (inputs_[i].name == name) next = i;
  if (next == enabled_) return;
  enabled_ = next;
  if (next != kNone)
    inputs_[next].written = false;  // A motion written before the source was enabled is discarded.
  settled_ = now + kSettle;
  pass(Stand{}, now);
}

void Mux::write(std::size_t index, const Motion& motion, Time now) {
  Input& input = inputs_[index];
  input.motion = motion;
  input.written = true;
  input.at = now;
  if (index == enabled_ && now >= settled_) pass(motion, now);
}

bool Mux::fresh(Time now) const {
  if (enabled_ == kNone) return false;
  const Input& input = inputs_[enabled_];
  return input.written && now - input.at < input.max_age;
}

void Mux::step(Time now) {
  if (!fresh(now) || now < settled_)
    pass(Stand{}, now);
  else
    pass(inputs_[enabled_].motion, now);
}

}  // namespace adit::agent

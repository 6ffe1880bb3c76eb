// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/rival.hpp"

namespace adit::agent {

bool RivalWatch::heard(const wire::ParticipantId& writer, Time now) {
  if (now - started_ < kGrace) return false;
  if (writer != writer_ || now - since_ > kWindow) {
    writer_ = writer;
    since_ = now;
    count_ = 0;
  }
  return ++count_ >= kSamples && reported_.pass(writer, now);
}

}  // namespace adit::agent

// SPDX-License-Identifier: Apache-2.0
#include "basestation/send/stick.hpp"

#include <algorithm>
#include <utility>

#include "adit/command.h"
#include "core/contract/command.hpp"
#include "core/wire/typed.hpp"

namespace adit::station {

struct Stick::Stream {
  std::string robot{};
  wire::Writer<radio::Joystick> writer{};
  contract::Joystick sample{};
  Source source{Source::held};
  bool active{false};
  bool pushed{false};  ///< The last sample sent was not centred.
  Time earliest{};     ///< Earliest time of the next sample at 20 Hz.
  Timer timer{};

  bool centred() const { return sample.twist.zero(); }
};

Stick::Stick(Id id, Executor& strand, wire::Participant& radio, Fleet& fleet)
    : id_(id), strand_(strand), radio_(radio), fleet_(fleet) {}

Stick::~Stick() = default;

Result<void> Stick::stream(const std::string& robot, const StickVelocity& velocity, Source source) {
  auto& stream = streams_[robot];
  if (!stream) {
    auto writer = wire::Writer<radio::Joystick>::make(radio_, wire::topics::kJoystick, robot);
    if (!writer) {
      streams_.erase(robot);
      return writer.error();
    }
    stream = std::make_unique<Stream>();
    stream->robot = robot;
    stream->writer = std::move(*writer);
    stream->sample.robot = robot;
    stream->sample.station_id = id_;
    stream->earliest = strand_.now();
  }
  // As it is sent: smaller changes are none.
  const Twist2 twist{static_cast<float>(velocity.vx), static_cast<float>(velocity.vy),
                     static_cast<float>(velocity.wz)};
  const bool changed = std::exchange(stream->sample.twist, twist) != twist;
  const bool repeat_suffices = stream->active && !changed && source == Source::held;
  const bool slower = stream->source == Source::live && source == Source::held;
  stream->source = source;
  stream->active = true;
  if (repeat_suffices && !slower) return {};
  const Time now = strand_.now();
  const bool lets_go = stream->pushed && stream->centred();  // A zero is sent at once; samples after it wait.
  if (lets_go || now + kTolerance >= stream->earliest)
    send(*stream, now);
  else
    arm(*stream, stream->earliest - kTolerance);
  return {};
}

void Stick::send(Stream& stream, Time at) {
  stream.earliest = std::max(stream.earliest, at) + kPeriod;
  arm(stream, at + (stream.source == Source::live ? kLiveRepeat : kPeriod));
  stream.pushed = !stream.centred();
  transmit(stream);
}

void Stick::arm(Stream& stream, Time due) {
  const Time now = strand_.now();
  // After a delay of the strand, missed samples are not sent.
  if (due < now) due = now;
  stream.timer = strand_.after(due - now, [this, &stream, due] { send(stream, due); });
}

void Stick::end(const std::string& robot) {
  const auto found = streams_.find(robot);
  if (found == streams_.end()) return;
  found->second->timer.cancel();
  found->second->active = false;  // The writer stays: its sequence continues.
}

bool Stick::streaming(const std::string& robot) const {
  const auto found = streams_.find(robot);
  return found != streams_.end() && found->second->active;
}

void Stick::transmit(Stream& stream) {
  const RobotView* robot = fleet_.robot(stream.robot);
  if (!robot || !robot->located) return;  // Without a stamp to echo, the robot would refuse the sample.
  stream.sample.epoch = robot->epoch;
  ++stream.sample.seq;
  stream.sample.echo = robot->stamp;
  // The next sample follows after 50 ms; the participant counts failures.
  (void)stream.writer.write(encode(stream.sample));
}

}  // namespace adit::station

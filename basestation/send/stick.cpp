#include "basestation/send/stick.hpp"

#include "adit/command.h"
#include "core/wire/typed.hpp"

namespace adit::station {

struct Stick::Stream {
  std::string robot{};
  wire::Writer<radio::Joystick> writer{};
  radio::Joystick sample{};
  Timer timer{};
};

Stick::Stick(Id id, Executor& strand, wire::Wire& radio, Fleet& fleet)
    : id_(id), strand_(strand), radio_(radio), fleet_(fleet) {}

Stick::~Stick() = default;

Result<void> Stick::stream(const std::string& robot, const std::array<double, 3>& velocity) {
  auto& stream = streams_[robot];
  if (!stream) {
    auto writer = wire::Writer<radio::Joystick>::make(radio_, wire::topics::joystick, robot);
    if (!writer) {
      streams_.erase(robot);
      return writer.error();
    }
    stream = std::make_unique<Stream>();
    stream->robot = robot;
    stream->writer = std::move(*writer);
    stream->sample.robot(robot);
    stream->sample.station_id(id_);
  }
  stream->sample.vx(static_cast<float>(velocity[0]));
  stream->sample.vy(static_cast<float>(velocity[1]));
  stream->sample.wz(static_cast<float>(velocity[2]));
  if (stream->timer.active()) return {};
  stream->timer = strand_.every(period, [this, &to = *stream] { transmit(to); });
  transmit(*stream);
  return {};
}

void Stick::end(const std::string& robot) {
  const auto found = streams_.find(robot);
  if (found != streams_.end()) found->second->timer.cancel();  // the writer stays: its sequence goes on
}

bool Stick::streaming(const std::string& robot) const {
  const auto found = streams_.find(robot);
  return found != streams_.end() && found->second->timer.active();
}

void Stick::transmit(Stream& stream) {
  const RobotView* robot = fleet_.robot(stream.robot);
  if (!robot || !robot->located) return;  // nothing to echo: the robot would refuse it
  stream.sample.epoch().start(robot->epoch.start);
  stream.sample.epoch().counter(robot->epoch.counter);
  stream.sample.seq(stream.sample.seq() + 1);
  stream.sample.echo(robot->stamp);
  (void)stream.writer.write(stream.sample);  // the next sample is 50 ms away; the wire counts failures
}

}  // namespace adit::station

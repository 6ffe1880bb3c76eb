// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/stick_stream.hpp"

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/robot.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"

namespace adit::sim {
namespace {

constexpr Duration kPeriod{50ms};
constexpr std::uint64_t kFirstSequence = 1'000'000;  // beyond any that the operator's station used
constexpr float kPush = 0.5F;                        // m/s

}  // namespace

struct StickStream::Endpoints {
  wire::Writer<radio::Joystick> joystick{};
  std::unique_ptr<wire::RawReader> authority{}, state{};
  radio::Epoch epoch{};
  std::uint64_t echo{};
  std::uint64_t sequence{kFirstSequence};
  Timer timer{};
};

StickStream::StickStream(wire::Participant& wire, std::shared_ptr<Executor> strand, std::string robot,
                         const StationId& id)
    : wire_(wire), strand_(std::move(strand)), robot_(std::move(robot)), id_(id) {}

StickStream::~StickStream() = default;

bool StickStream::heard() const { return endpoints_ && endpoints_->echo != 0; }
std::uint64_t StickStream::start_of_epoch() const { return endpoints_->epoch.start(); }
std::uint32_t StickStream::epoch_counter() const { return endpoints_->epoch.counter(); }
std::uint64_t StickStream::sequence() const { return endpoints_->sequence; }

Result<void> StickStream::start() {
  endpoints_ = std::make_unique<Endpoints>();
  auto joystick = wire::Writer<radio::Joystick>::make(wire_, wire::topics::kJoystick, robot_);
  if (!joystick) return joystick.error();
  endpoints_->joystick = std::move(*joystick);
  auto authority = wire::make_reader<radio::AuthorityStatus>(
      wire_, wire::topics::kAuthority, *strand_,
      [this](const radio::AuthorityStatus& s, const wire::SampleInfo&) {
        if (s.robot() == robot_) endpoints_->epoch = s.epoch();
      });
  if (!authority) return authority.error();
  endpoints_->authority = std::move(*authority);
  auto state =
      wire::make_reader<radio::RobotState>(wire_, wire::topics::kRobotState, *strand_,
                                           [this](const radio::RobotState& s, const wire::SampleInfo&) {
                                             if (s.robot() == robot_) endpoints_->echo = s.stamp();
                                           });
  if (!state) return state.error();
  endpoints_->state = std::move(*state);
  endpoints_->timer = strand_->every(kPeriod, [this] { write(); });
  return {};
}

void StickStream::write() {
  Endpoints& e = *endpoints_;
  if (e.echo == 0) return;
  radio::Joystick sample;
  sample.robot(robot_);
  sample.station_id(id_);
  sample.epoch(e.epoch);
  sample.seq(++e.sequence);
  sample.echo(e.echo);
  sample.vx(kPush);
  (void)e.joystick.write(sample);  // whether it arrives is what the scenario looks at
}

}  // namespace adit::sim

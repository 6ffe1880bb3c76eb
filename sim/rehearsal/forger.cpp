#include "sim/rehearsal/forger.hpp"

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/robot.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"

namespace adit::sim {
namespace {

constexpr Duration period{50ms};
constexpr std::uint64_t first_sequence = 1'000'000;  // beyond any that the operator's station used

}  // namespace

struct Forger::Endpoints {
  std::unique_ptr<Runtime> runtime{};
  std::shared_ptr<Executor> strand{};
  std::unique_ptr<wire::Wire> wire{};
  wire::Writer<radio::Command> command{};
  wire::Writer<radio::Joystick> joystick{};
  std::unique_ptr<wire::RawReader> authority{}, state{};
  radio::Epoch epoch{};
  std::uint64_t echo{};
  std::uint64_t sequence{first_sequence};
  Timer timer{};
};

Forger::Forger(Stage& stage, const Forge& forge, const StationId& id)
    : stage_(stage), forge_(forge), id_(id) {}

Forger::~Forger() = default;

Result<void> Forger::start() {
  const std::string machine = "foreign";
  endpoints_ = std::make_unique<Endpoints>();
  Endpoints& e = *endpoints_;
  e.runtime = stage_.scheduler.machine(machine, 5s);
  e.strand = e.runtime->strand(machine);
  e.wire = stage_.ether.join(Witness::radio_domain, machine);
  auto command = wire::Writer<radio::Command>::make(*e.wire, wire::topics::command, forge_.robot);
  if (!command) return command.error();
  e.command = std::move(*command);
  auto joystick = wire::Writer<radio::Joystick>::make(*e.wire, wire::topics::joystick, forge_.robot);
  if (!joystick) return joystick.error();
  e.joystick = std::move(*joystick);
  auto authority = wire::make_reader<radio::AuthorityStatus>(
      *e.wire, wire::topics::authority, *e.strand,
      [this](const radio::AuthorityStatus& s, const wire::SampleInfo&) {
        if (s.robot() == forge_.robot) endpoints_->epoch = s.epoch();
      });
  if (!authority) return authority.error();
  e.authority = std::move(*authority);
  auto state =
      wire::make_reader<radio::RobotState>(*e.wire, wire::topics::robot_state, *e.strand,
                                           [this](const radio::RobotState& s, const wire::SampleInfo&) {
                                             if (s.robot() == forge_.robot) endpoints_->echo = s.stamp();
                                           });
  if (!state) return state.error();
  e.state = std::move(*state);
  e.timer = e.strand->every(period, [this] { write(); });
  stage_.scheduler.at(stage_.scheduler.elapsed() + forge_.duration, [this] { endpoints_.reset(); });
  return {};
}

void Forger::write() {
  Endpoints& e = *endpoints_;
  if (e.echo == 0) return;  // nothing was heard of the robot yet
  static constexpr std::array kinds{radio::CMD_MODE, radio::CMD_GOTO, radio::CMD_RELEASE, radio::CMD_RESET};
  const std::uint64_t step = ++e.sequence;
  radio::Joystick sample;
  sample.robot(forge_.robot);
  sample.station_id(id_);
  sample.epoch(e.epoch);
  sample.seq(step);
  sample.echo(e.echo);
  sample.vx(0.5F);
  (void)e.joystick.write(sample);  // whether it arrives is what the scenario looks at
  if (step % 10 != 0) return;
  radio::Command command;
  command.robot(forge_.robot);
  command.station(forge_.as);
  command.station_id(id_);
  command.epoch(e.epoch);
  command.seq(step);
  command.kind(kinds[step / 10 % kinds.size()]);
  command.text(command.kind() == radio::CMD_MODE ? "waypoint" : "");
  command.position({2.0, 2.0, 0.0});
  command.flag(true);
  (void)e.command.write(command);
}

}  // namespace adit::sim

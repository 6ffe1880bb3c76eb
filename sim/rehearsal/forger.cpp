// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/forger.hpp"

#include <array>

#include "adit/command.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "sim/rehearsal/stick_stream.hpp"

namespace adit::sim {
namespace {

constexpr Duration kPeriod{500ms};

}  // namespace

struct Forger::Endpoints {
  std::unique_ptr<Runtime> runtime{};
  std::shared_ptr<Executor> strand{};
  std::unique_ptr<wire::Participant> wire{};
  wire::Writer<radio::Command> command{};
  std::unique_ptr<StickStream> stick{};
  std::size_t step{};
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
  e.wire = stage_.network.join(Witness::kRadioDomain, machine);
  auto command = wire::Writer<radio::Command>::make(*e.wire, wire::topics::kCommand, forge_.robot);
  if (!command) return command.error();
  e.command = std::move(*command);
  e.stick = std::make_unique<StickStream>(*e.wire, e.strand, forge_.robot, id_);
  if (auto started = e.stick->start(); !started) return started;
  e.timer = e.strand->every(kPeriod, [this] { write(); });
  stage_.scheduler.at(stage_.scheduler.elapsed() + forge_.duration, [this] { endpoints_.reset(); });
  return {};
}

void Forger::write() {
  Endpoints& e = *endpoints_;
  if (!e.stick->heard()) return;
  static constexpr std::array kinds{radio::CMD_MODE, radio::CMD_GOTO, radio::CMD_RELEASE, radio::CMD_RESET};
  radio::Command command;
  command.robot(forge_.robot);
  command.station(forge_.as);
  command.station_id(id_);
  command.epoch().start(e.stick->start_of_epoch());
  command.epoch().counter(e.stick->epoch_counter());
  command.seq(e.stick->sequence());
  command.kind(kinds[e.step++ % kinds.size()]);
  if (command.kind() == radio::CMD_MODE) command.words({"waypoint"});
  if (command.kind() == radio::CMD_GOTO) command.numbers({2.0, 2.0});
  if (command.kind() == radio::CMD_RESET) command.options(1);
  (void)e.command.write(command);  // whether it arrives is what the scenario looks at
}

}  // namespace adit::sim

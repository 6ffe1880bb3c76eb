// SPDX-License-Identifier: Apache-2.0
#include "tests/station/fake_robot.hpp"

#include <algorithm>
#include <utility>

namespace adit::station {

using namespace std::chrono_literals;

FakeRobot::FakeRobot(VirtualScheduler& scheduler, wire::SimulatedNetwork& network, std::string name)
    : scheduler_(scheduler),
      name_(std::move(name)),
      machine_(scheduler.machine(name_, 1000s)),
      strand_(machine_->strand("robot")),
      wire_(network.join(77, name_)) {
  state_ = wire::Writer<radio::RobotState>::make(*wire_, wire::topics::kRobotState).value();
  authority_ = wire::Writer<radio::AuthorityStatus>::make(*wire_, wire::topics::kAuthority).value();
  behaviour_ = wire::Writer<radio::BehaviourState>::make(*wire_, wire::topics::kBehaviour).value();
  answers_ = wire::Writer<radio::Acknowledgement>::make(*wire_, wire::topics::kAcknowledgement).value();
  readers_.push_back(wire::make_reader(
                         *wire_, wire::topics::kCommand, *strand_,
                         [this](const radio::Command& command, const wire::SampleInfo&) {
                           commands_.push_back({scheduler_.elapsed(), command});
                           answer(command);
                         },
                         name_)
                         .value());
  readers_.push_back(wire::make_reader(
                         *wire_, wire::topics::kJoystick, *strand_,
                         [this](const radio::Joystick& sample, const wire::SampleInfo&) {
                           sticks_.push_back({scheduler_.elapsed(), sample});
                         },
                         name_)
                         .value());
  bulk_ = wire::Writer<radio::BulkPiece>::make(*wire_, wire::topics::kBulk).value();
  readers_.push_back(wire::make_reader(*wire_, wire::topics::kBulkAck, *strand_,
                                       [this](const radio::BulkAck& ack, const wire::SampleInfo&) {
                                         piece_acks_.push_back(ack);
                                       })
                         .value());
  behaviour.robot(name_);
  behaviour.mode("hold");
  timers_.push_back(strand_->every(100ms, [this] {
    if (!alive) return;
    radio::RobotState sample;
    sample.robot(name_);
    sample.stamp(to_stamp(strand_->now()));
    (void)state_.write(sample);
  }));
  timers_.push_back(strand_->every(1s, [this] { publish(); }));
}

void FakeRobot::publish() {
  if (!alive) return;
  radio::AuthorityStatus authority;
  authority.robot(name_);
  authority.epoch().start(epoch_start);
  authority.epoch().counter(epoch);
  authority.holder(holder);
  authority.holder_id(holder_id);
  (void)authority_.write(authority);
  (void)behaviour_.write(behaviour);
}

void FakeRobot::describe(float max_speed, float max_turn, bool holonomic, float step) {
  if (!capabilities_)
    capabilities_ = wire::Writer<radio::Capabilities>::make(*wire_, wire::topics::kCapabilities).value();
  radio::Capabilities sample;
  sample.name(name_);
  sample.kind(radio::AGENT_ROBOT);
  sample.platform("wheeled");
  sample.max_speed(max_speed);
  sample.max_turn(max_turn);
  sample.holonomic(holonomic);
  sample.stairs(step > 0.0F);
  sample.step(step);
  (void)capabilities_.write(sample);
}

void FakeRobot::refuse_stream(const std::string& station, Id kId, Reason reason) {
  radio::Acknowledgement sample;
  sample.robot(name_);
  sample.station(station);
  sample.station_id(kId);
  sample.reason(static_cast<std::uint16_t>(reason));
  sample.holder(holder);
  sample.epoch().start(epoch_start);
  sample.epoch().counter(epoch);
  (void)answers_.write(sample);
}

void FakeRobot::act(const radio::Command& command) {
  if (command.kind() == radio::CMD_TAKE || command.kind() == radio::CMD_RELEASE) {
    holder = command.kind() == radio::CMD_TAKE ? command.station() : "";
    holder_id = command.kind() == radio::CMD_TAKE ? command.station_id() : Id{};
    ++epoch;
  } else if (command.kind() == radio::CMD_MODE) {
    behaviour.mode(command.words().at(0));
  } else if (command.kind() == radio::CMD_STOP) {
    behaviour.stopped(true);
    behaviour.mode("hold");
  } else if (command.kind() == radio::CMD_GOTO) {
    behaviour.mode("waypoint");
    behaviour.goal_id(behaviour.goal_id() + 1);
    behaviour.goal({command.numbers().at(0), command.numbers().at(1), 0.0});
    behaviour.goal_state(radio::GOAL_ACTIVE);
  }
}

void FakeRobot::answer(const radio::Command& command) {
  if (!alive) return;
  const auto before = answered_.find(command.seq());
  if (before != answered_.end()) return void(answers_.write(before->second));
  const auto reason = answering ? answering(command) : std::optional(Reason::none);
  if (!reason) return;
  if (*reason == Reason::none && (!acting || acting(command))) act(command);
  radio::Acknowledgement sample;
  sample.robot(name_);
  sample.station(command.station());
  sample.station_id(command.station_id());
  sample.seq(command.seq());
  sample.accepted(*reason == Reason::none);
  sample.reason(static_cast<std::uint16_t>(*reason));
  sample.holder(holder);
  sample.epoch().start(epoch_start);
  sample.epoch().counter(epoch);
  if (route && sample.accepted() && command.kind() == radio::CMD_PLAN) sample.route({*route});
  answered_[command.seq()] = sample;
  (void)answers_.write(sample);
  publish();
}

std::vector<std::uint64_t> FakeRobot::numbers() const {
  std::vector<std::uint64_t> out;
  for (const Heard& heard : commands_)
    if (std::find(out.begin(), out.end(), heard.command.seq()) == out.end())
      out.push_back(heard.command.seq());
  return out;
}

StationTest::StationTest(wire::LinkProfile link, std::uint64_t seed)
    : network_(scheduler_, {.seed = seed, .link = std::move(link)}),
      machine_(scheduler_.machine("op", 5s)),
      strand_(machine_->strand("station")) {}

StationTest::~StationTest() = default;

FakeRobot& StationTest::add(const std::string& name) {
  robots_.push_back(std::make_unique<FakeRobot>(scheduler_, network_, name));
  return *robots_.back();
}

Station& StationTest::start(const std::string& name) {
  op_.reset();
  wire_ = network_.join(77, "op");
  op_ = std::make_unique<Station>(StationParams{.name = name, .id = kId}, *strand_, *wire_);
  EXPECT_TRUE(op_->start().ok());
  return *op_;
}

Outcome StationTest::execute(const std::string& line, Duration limit) {
  auto ended = std::make_shared<std::optional<Outcome>>();
  strand_->post(
      [this, line, ended] { op_->execute(line, [ended](const Outcome& outcome) { *ended = outcome; }); });
  const Duration until = scheduler_.elapsed() + limit;
  while (!*ended && scheduler_.elapsed() < until) run_for(10ms);
  if (!*ended) ADD_FAILURE() << line << " did not end";
  return ended->value_or(Outcome{.exit_code = -1});
}

std::uint64_t StationTest::begin(const std::string& line) {
  std::uint64_t handle = 0;
  strand_->post(
      [&] { handle = op_->execute(line, [this](const Outcome& outcome) { late_.push_back(outcome); }); });
  run_for(1us);
  return handle;
}

}  // namespace adit::station

#include "robot_agent/agent.hpp"

#include <stdexcept>

#include "core/config/search.hpp"
#include "core/exec/hang.hpp"
#include "core/time/random.hpp"
#include "nav/control/controller.hpp"
#include "robot_agent/agent_core.hpp"

namespace adit::agent {
namespace {

// What a seed is used for; each has its own sequence.
constexpr std::uint64_t kIdentitySalt = 1;

Id drawn(Random random) {
  Id id{};
  for (std::size_t i = 0; i < id.size(); i += 8) {
    std::uint64_t word = random.next();
    for (std::size_t k = 0; k < 8; ++k, word >>= 8) id[i + k] = static_cast<std::uint8_t>(word);
  }
  return id;
}

}  // namespace

Agent::Agent(AgentParams params, Runtime& runtime, wire::Wire& radio, wire::Wire& robot)
    : params_(std::move(params)), runtime_(runtime), radio_(radio), robot_(robot) {
  if (params_.id == Id{}) params_.id = drawn(Random(params_.seed).fork(kIdentitySalt));
}

Agent::~Agent() {
  // First nothing more arrives, then the strands end, then the parts go.
  if (core_) core_->close();
  sensors_.reset();
  disk_.reset();
  command_.reset();
  if (core_) core_->stop();
}

Result<void> Agent::start() {
  if (core_) return {Reason::in_use, "the agent runs already"};
  if (!valid_name(params_.name))
    return {Reason::bad_argument, "a robot's name is 1 to 32 of [A-Za-z0-9_-], not '" + params_.name + "'"};
  if (const auto known = nav::make_controller(params_.platform.controller, params_.platform); !known)
    return {known.error().reason, "platform " + params_.platform.name + ": " + known.error().text};
  const auto tree = config::find_file(params_.tree);
  if (!tree) return tree.error();
  auto decider = Decider::load(*tree);
  if (!decider) return decider.error();
  command_ = runtime_.strand("command");
  sensors_ = runtime_.strand("sensors");
  auto radio = RadioEdge::open(radio_, *command_, params_.name);
  if (!radio) return radio.error();
  if (params_.disk && !params_.disk->instant()) disk_ = runtime_.strand("disk");
  params_.id = restore_identity(params_.disk, params_.id);
  core_ = std::make_unique<Core>(params_, *command_, std::move(*decider), std::move(*radio), disk_);
  if (const auto opened = core_->open(robot_, *sensors_); !opened) return opened.error();
  command_->post([core = core_.get()] {
    if (const auto started = core->start(); !started) core->report(started.error());
  });
  return {};
}

void Agent::at_console(const std::string& line, std::function<void(const std::string&)> answer) {
  command_->post([core = core_.get(), line, answer = std::move(answer)] { answer(core->at_console(line)); });
}

Result<void> Agent::inject(const std::string& component, ComponentFault fault) {
  Executor* strand = component == "command"   ? command_.get()
                     : component == "sensors" ? sensors_.get()
                                              : nullptr;
  if (!strand) return {Reason::bad_argument, "no component is named " + component};
  strand->post([strand, fault] {
    if (fault == ComponentFault::hang) hang(*strand);
    throw std::runtime_error("a crash on request");
  });
  return {};
}

}  // namespace adit::agent

// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/agent.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "core/time/random.hpp"
#include "nav/control/controller.hpp"
#include "nav/planners/make_planner.hpp"
#include "robot_agent/agent_impl.hpp"
#include "robot_agent/common/console_answer.hpp"

namespace adit::agent {
namespace {

Id drawn(Random random) {
  Id id{};
  for (std::size_t i = 0; i < id.size(); i += 8) {
    std::uint64_t word = random.next();
    for (std::size_t k = 0; k < 8; ++k, word >>= 8) id[i + k] = static_cast<std::uint8_t>(word);
  }
  return id;
}

findings::Finding stamped(findings::Finding finding, Time now) {
  if (finding.stamp == 0) finding.stamp = to_stamp(now);
  return finding;
}

}  // namespace

Agent::Agent(AgentParams params, Runtime& runtime, wire::Participant& radio, wire::Participant& robot)
    : params_(std::move(params)), runtime_(runtime), radio_(radio), robot_(robot) {
  if (params_.id == Id{}) params_.id = drawn(Random(params_.seed).fork(kIdentitySalt));
}

Agent::~Agent() = default;

Result<void> Agent::start() {
  if (impl_) return {Reason::in_use, "the agent runs already"};
  if (!command::valid_robot_name(params_.name))
    return {Reason::bad_argument,
            "a robot's name is " + std::string(command::kRobotName) + ": '" + params_.name + "'"};
  if (const auto known = nav::make_controller(params_.platform.controller, params_.platform); !known)
    return {known.error().reason, "platform " + params_.platform.name + ": " + known.error().text};
  if (const auto known = nav::fits(params_.platform); !known)
    return {known.error().reason, "platform " + params_.platform.name + ": " + known.error().text};
  if (params_.platform.router != "none" && params_.platform.router != "graph")
    return {Reason::bad_argument, "platform " + params_.platform.name + ": no router '" +
                                      params_.platform.router + "': expected graph or none"};
  if (params_.platform.router != "none" && params_.platform.flies())
    return {Reason::bad_argument, "platform " + params_.platform.name + ": router '" +
                                      params_.platform.router + "' leads over ground: none for what flies"};
  params_.id = restore_identity(params_.disk, params_.id);
  auto impl = std::make_unique<Impl>(params_, runtime_);
  if (const auto opened = impl->open(radio_, robot_); !opened) return opened.error();
  impl_ = std::move(impl);
  impl_->watch->start();
  return {};
}

void Agent::at_console(const std::string& line, std::function<void(const std::string&)> answer) {
  if (line == "health") return impl_->watch->describe(std::move(answer));
  std::istringstream in(line);
  const std::vector<std::string> words(std::istream_iterator<std::string>(in), {});
  const bool restarts = words.size() == 2 && words[0] == "restart";
  const bool automatic = words.size() == 3 && words[2] == "auto";
  if (restarts || (words.size() == 3 && words[0] == "policy" && (automatic || words[2] == "manual"))) {
    const auto done =
        restarts ? impl_->watch->restart(words[1]) : impl_->watch->set_policy(words[1], automatic);
    return answer(done ? "done\n" : refused_at_console(done.error().text));
  }
  impl_->command_strand().post([context = impl_->context.get(), line, answer = std::move(answer)] {
    answer(context->command_component ? context->command_component->at_console(line)
                                      : refused_at_console("the command component is being restarted"));
  });
}

void Agent::report(findings::Finding finding) {
  impl_->with_findings([finding = std::move(finding)](FindingSource& source, Time now) -> Result<void> {
    const auto taken = source.report(stamped(finding, now));
    return taken ? Result<void>{} : taken.error();
  });
}

void Agent::update(findings::Finding finding) {
  impl_->with_findings([finding = std::move(finding)](FindingSource& source, Time now) -> Result<void> {
    if (source.has(finding.key.id)) return source.update(stamped(finding, now));
    const auto taken = source.report(stamped(finding, now));
    return taken ? Result<void>{} : taken.error();
  });
}

void Agent::withdraw(std::uint64_t id) {
  impl_->with_findings([id](FindingSource& source, Time) { return source.withdraw(id); });
}

void Agent::map_frame(Executor& caller, std::function<void(const Result<MapFrame>&)> done) {
  impl_->context->frames.find.call(caller, {}, {}, std::move(done));
}

void Agent::correct_map(Executor& caller, const MapFrame& corrected,
                        std::function<void(const Result<MapFrame>&)> done) {
  impl_->context->frames.correct.call(caller, corrected, {}, std::move(done));
}

Result<void> Agent::inject(const std::string& component, ComponentFault fault) {
  Unit* unit = impl_ ? impl_->find(component) : nullptr;
  if (!unit) return {Reason::bad_argument, "no component is named " + component};
  unit->inject(fault);
  return {};
}

}  // namespace adit::agent

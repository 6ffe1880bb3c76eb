// SPDX-License-Identifier: Apache-2.0
#include "basestation/flow/flows.hpp"

namespace adit::station {
namespace {
constexpr const char* kReplaced = "another command took its place";
}  // namespace

Flows::Chosen Flows::of(std::uint64_t handle) const {
  Chosen chosen;
  for (auto [at, end] = flows_.equal_range(handle); at != end; ++at) chosen.push_back(at->second);
  return chosen;
}

Flows::Chosen Flows::drives_of(const std::string& robot) const {
  Chosen drives;
  for (const auto& [handle, flow] : flows_)
    if (flow->is_drive() && flow->robot() == robot) drives.push_back(flow);
  return drives;
}

Result<void> Flows::start(std::uint64_t handle, const std::shared_ptr<Flow>& flow) {
  drop_ended();
  const Chosen replaced = flow->is_drive() ? drives_of(flow->robot()) : Chosen{};
  if (flows_.size() - replaced.size() >= kMaxFlows)
    return {Reason::queue_full, "64 drives and waits are going on at this station already"};
  for (const auto& other : replaced) other->hand_over();
  drop_ended();
  flows_.emplace(handle, flow);
  flow->start();
  return {};
}

void Flows::cancel(std::uint64_t handle) {
  for (const auto& flow : of(handle)) flow->cancel(Reason::cancelled, "");
}

void Flows::set_velocity(std::uint64_t handle, const StickVelocity& velocity) {
  for (const auto& flow : of(handle)) flow->set_velocity(velocity);
}

void Flows::stream_refused(const std::string& robot, Reason reason, const std::string& text) {
  for (const auto& drive : drives_of(robot)) drive->stream_refused(reason, text);
}

void Flows::end_drives(const std::string& robot, Reason reason) {
  for (const auto& drive : drives_of(robot))
    drive->cancel(reason, reason == Reason::cancelled ? kReplaced : "");
}

Flow::Done Flows::end_drives_when_accepted(const std::string& robot) const {
  const Chosen drives = drives_of(robot);
  return [drives = std::vector<std::weak_ptr<Flow>>(drives.begin(), drives.end())](const Answer& answer) {
    if (!answer.accepted) return;
    for (const auto& weak : drives)
      if (const auto drive = weak.lock()) drive->cancel(Reason::cancelled, kReplaced);
  };
}

void Flows::drop_ended() {
  std::erase_if(flows_, [](const auto& entry) { return entry.second->over(); });
}

}  // namespace adit::station

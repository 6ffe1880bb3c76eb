// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/desk.hpp"

namespace adit::station {
namespace {

constexpr std::size_t kRobots = 64;

}  // namespace

FindingDesk::FindingDesk(DeskParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                         Outputs outputs)
    : outputs_(std::move(outputs)),
      finding_store_({.max_findings = params.max_findings}, std::move(disk), home, nullptr,
                     {[this](const findings::Key& key) { answers_[key.robot].insert(key.id); },
                      [this](bool failing, const std::string& text) {
                        outputs_.trouble(failing ? "store_failing" : "store_works", text);
                      }}) {}

void FindingDesk::hear(findings::Finding finding, const Robot& robot) {
  if (!findings::valid(finding)) return;
  const findings::Key key = finding.key;
  if (!robots_.contains(key.robot) && robots_.size() >= kRobots) return;
  robots_[key.robot] = robot;
  if (finding_store_.kept(key)) {
    answers_[key.robot].insert(key.id);  // The previous acknowledgement was lost.
    return;
  }
  if (finding_store_.all().contains(key)) return;  // It is being written to the disk.
  if (!finding_store_.put(std::move(finding))) {
    if (!told_full_)
      outputs_.trouble("findings_full", "no room for more findings here; " + key.robot + " keeps its own");
    told_full_ = true;
    return;
  }
  outputs_.found(finding_store_.all().at(key));
}

void FindingDesk::tick() {
  for (auto& [robot, ids] : answers_) {
    while (!ids.empty()) {
      std::vector<std::uint64_t> some;
      while (!ids.empty() && some.size() < kIds) {
        some.push_back(*ids.begin());
        ids.erase(ids.begin());
      }
      outputs_.acknowledge(robot, some);
    }
  }
}

}  // namespace adit::station

// SPDX-License-Identifier: Apache-2.0
#include "core/exec/job_queue.hpp"

#include <algorithm>

namespace adit {
namespace {

void remove(std::vector<std::shared_ptr<LiveJob>>& jobs, const LiveJob& job) {
  std::erase_if(jobs, [&](const auto& j) { return j.get() == &job; });
}

}  // namespace

JobQueue::Added JobQueue::add(std::shared_ptr<LiveJob> job) {
  std::erase_if(waiting_, [](const auto& j) { return j->settled(); });
  const auto same_lane = [&](const auto& j) { return j->shares_lane(*job); };
  if (std::any_of(hanging_.begin(), hanging_.end(), same_lane))
    return {Error{Reason::no_answer, job->spec.name + ": the job before it does not return"}, nullptr};
  if (job->spec.latest_only) {
    const auto older = std::find_if(waiting_.begin(), waiting_.end(), [&](const auto& j) {
      return j->shares_lane(*job) && j->spec.name == job->spec.name;
    });
    if (older != waiting_.end()) return {{}, std::exchange(*older, std::move(job))};
  }
  if (waiting_.size() >= capacity_)
    return {Error{Reason::queue_full, job->spec.name + ": too many jobs"}, {}};
  waiting_.push_back(std::move(job));
  return {};
}

bool JobQueue::lane_busy(std::size_t index) const {
  const LiveJob& job = *waiting_[index];
  if (job.spec.lane.empty()) return false;
  const auto same_lane = [&](const auto& j) { return j->shares_lane(job); };
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(index);
  return std::any_of(running_.begin(), running_.end(), same_lane) ||
         std::any_of(waiting_.begin(), end, same_lane);
}

std::size_t JobQueue::best() const {
  std::size_t best = waiting_.size();
  for (std::size_t i = 0; i < waiting_.size(); ++i)
    if ((best == waiting_.size() || waiting_[i]->spec.priority < waiting_[best]->spec.priority) &&
        !lane_busy(i))
      best = i;
  return best;
}

std::shared_ptr<LiveJob> JobQueue::next() {
  const std::size_t found = best();
  if (found == waiting_.size()) return nullptr;
  auto job = std::move(waiting_[found]);
  waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(found));
  if (!job->spec.lane.empty()) running_.push_back(job);
  return job;
}

void JobQueue::finished(const LiveJob& job) {
  remove(running_, job);
  remove(hanging_, job);
}

std::vector<std::shared_ptr<LiveJob>> JobQueue::hangs(const std::shared_ptr<LiveJob>& job) {
  std::vector<std::shared_ptr<LiveJob>> behind;
  if (job->spec.lane.empty()) return behind;
  hanging_.push_back(job);
  for (const auto& j : waiting_)
    if (j->shares_lane(*job)) behind.push_back(j);
  std::erase_if(waiting_, [&](const auto& j) { return j->shares_lane(*job); });
  return behind;
}

std::vector<std::shared_ptr<LiveJob>> JobQueue::clear() {
  std::vector<std::shared_ptr<LiveJob>> all(waiting_.begin(), waiting_.end());
  waiting_.clear();
  return all;
}

}  // namespace adit

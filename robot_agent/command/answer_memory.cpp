#include "robot_agent/command/answer_memory.hpp"

#include <algorithm>

namespace adit::agent {

const Answer* AnswerMemory::find(const wire::ParticipantId& from, std::uint64_t seq) const {
  const auto entry = entries_.find(from);
  if (entry == entries_.end()) return nullptr;
  const Answer& slot = entry->second.answers[seq % kAnswers];
  return slot.seq == seq && seq != 0 ? &slot : nullptr;
}

bool AnswerMemory::too_old(const wire::ParticipantId& from, std::uint64_t seq, bool steers) const {
  const auto entry = entries_.find(from);
  if (entry == entries_.end()) return false;
  const auto& [answers, newest, newest_steering, used] = entry->second;
  return (newest >= kAnswers && seq <= newest - kAnswers) || (steers && seq < newest_steering);
}

void AnswerMemory::remember(const wire::ParticipantId& from, const Answer& answer, bool steers, Time now) {
  if (!entries_.contains(from) && entries_.size() >= kParticipants)
    entries_.erase(std::min_element(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    }));
  Entry& entry = entries_[from];
  if (entry.answers.empty()) entry.answers.resize(kAnswers);
  entry.used = now;
  // A number older than what its slot holds was answered stale; the newer answer stays.
  Answer& slot = entry.answers[answer.seq % kAnswers];
  if (answer.seq > slot.seq) slot = answer;
  entry.newest = std::max(entry.newest, answer.seq);
  if (steers) entry.newest_steering = std::max(entry.newest_steering, answer.seq);
}

}  // namespace adit::agent

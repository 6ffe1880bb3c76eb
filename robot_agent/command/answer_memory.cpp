#include "robot_agent/command/answer_memory.hpp"

#include <algorithm>

namespace adit::agent {

const Answer* AnswerMemory::find(const wire::ParticipantId& from, std::uint64_t seq) const {
  const auto entry = entries_.find(from);
  if (entry == entries_.end()) return nullptr;
  const Answer& slot = entry->second.answers[seq % kAnswers];
  return slot.seq == seq && seq != 0 ? &slot : nullptr;
}

bool AnswerMemory::too_old(const wire::ParticipantId& from, std::uint64_t seq, Line line) const {
  const auto entry = entries_.find(from);
  if (entry == entries_.end()) return false;
  const std::uint64_t newest = entry->second.newest;
  const bool overtaken = line != Line::none && seq < entry->second.newest_of[static_cast<std::size_t>(line)];
  return (newest >= kAnswers && seq <= newest - kAnswers) || overtaken;
}

void AnswerMemory::remember(const wire::ParticipantId& from, const Answer& answer, Line line, Time now) {
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
  std::uint64_t& newest = entry.newest_of[static_cast<std::size_t>(line)];
  newest = std::max(newest, answer.seq);
}

}  // namespace adit::agent

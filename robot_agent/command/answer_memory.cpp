// SPDX-License-Identifier: Apache-2.0
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
  const ParticipantAnswers& e = entry->second;
  const bool overtaken = line != Line::none && seq < e.newest_of[static_cast<std::size_t>(line)];
  return (e.newest >= kAnswers && seq <= e.newest - kAnswers) || overtaken || seq < e.floor;
}

void AnswerMemory::remember(const wire::ParticipantId& from, const Answer& answer, Line line, bool durable,
                            Time now, const wire::ParticipantId* holder) {
  if (!entries_.contains(from) && entries_.size() >= kParticipants)
    entries_.erase(std::min_element(entries_.begin(), entries_.end(), [&](const Entry& a, const Entry& b) {
      return worth(a, holder) < worth(b, holder);
    }));
  if (durable && answer.reason == Reason::none) ++accepted_;
  ParticipantAnswers& entry = entries_[from];
  if (entry.answers.empty()) entry.answers.resize(kAnswers);
  entry.used = now;
  entry.obeyed = entry.obeyed || (durable && answer.reason == Reason::none);
  // A number older than the one in its slot was refused as stale; the newer answer stays.
  Answer& slot = entry.answers[answer.seq % kAnswers];
  if (answer.seq > slot.seq) slot = answer;
  entry.newest = std::max(entry.newest, answer.seq);
  std::uint64_t& newest = entry.newest_of[static_cast<std::size_t>(line)];
  newest = std::max(newest, answer.seq);
}

std::tuple<bool, bool, Time> AnswerMemory::worth(const Entry& entry, const wire::ParticipantId* holder) {
  return {holder != nullptr && entry.first == *holder, entry.second.obeyed, entry.second.used};
}

std::vector<StoredAnswers> AnswerMemory::stored(const wire::ParticipantId* holder) const {
  std::vector<std::pair<std::tuple<bool, bool, Time>, StoredAnswers>> all;
  for (const Entry& of : entries_) {
    const auto& [participant, entry] = of;
    StoredAnswers k{participant, {}, {}, entry.newest, entry.newest_of, entry.floor, {}};
    std::vector<const Answer*> answers;
    for (const Answer& a : entry.answers)
      if (a.seq != 0) answers.push_back(&a);
    std::sort(answers.begin(), answers.end(),
              [](const Answer* a, const Answer* b) { return a->seq < b->seq; });
    if (answers.empty()) continue;
    if (answers.size() > StoredAnswers::kAnswers) {
      answers.erase(answers.begin(), answers.end() - StoredAnswers::kAnswers);
      k.floor = std::max(k.floor, answers.front()->seq);
    }
    k.station = answers.back()->station;
    k.station_id = answers.back()->station_id;
    for (const Answer* a : answers)
      k.answers.push_back({a->seq, a->reason, a->text.substr(0, StoredAnswer::kText)});
    all.emplace_back(worth(of, holder), std::move(k));
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<StoredAnswers> stored;
  for (auto& [order, answers] : all)
    if (stored.size() < StoredAnswers::kParticipants) stored.push_back(std::move(answers));
  return stored;
}

void AnswerMemory::restore(const std::vector<StoredAnswers>& stored, Time now) {
  for (const StoredAnswers& k : stored) {
    ParticipantAnswers& entry = entries_[k.participant];
    entry.answers.resize(kAnswers);
    entry.newest = k.newest;
    entry.newest_of = k.newest_of;
    entry.floor = k.floor;
    entry.used = now;
    entry.obeyed = true;  // Answers to questions are not stored alone.
    for (const StoredAnswer& a : k.answers)
      entry.answers[a.seq % kAnswers] = {
          .station = k.station, .station_id = k.station_id, .seq = a.seq, .reason = a.reason, .text = a.text};
  }
}

}  // namespace adit::agent

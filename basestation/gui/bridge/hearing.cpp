// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/hearing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

/// In the order of their priority; others follow.
constexpr std::array kClasses{"urgent", "discovery", "stream", "state", "status", "bulk", "video"};

void mark(double lost, HearingCell& cell) {
  if (!(lost >= 0.0 && lost <= 1.0)) return;
  const bool deaf = lost >= 1.0;
  cell.text = deaf ? "nothing" : station::fixed(lost * 100.0, 0) + " % lost";
  cell.shape = deaf ? "square" : lost > kLossy ? "triangle" : "disc";
  cell.token = deaf ? Token::bad : lost > kLossy ? Token::warn : Token::ok;
}

}  // namespace

HearingTable hearing_table(const station::NetworkReport& report, const std::string& own) {
  std::map<std::string, std::map<std::string, double>> heard;  // Lost share by hearer and speaker.
  std::vector<std::string> hearers{own}, speakers;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (names.size() < kMaxHearing && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  add(speakers, own);
  for (const station::LinkReport& link : report.links) {
    add(hearers, link.agent);
    add(speakers, link.agent);
    heard[own][link.agent] = link.age > kSilent ? 1.0 : link.lost_from;
    if (link.lost_to) heard[link.agent][own] = *link.lost_to;
  }
  // What an agent says it hears takes only the places that are left.
  for (const station::AgentTraffic& agent : report.agents)
    if (agent.age <= kSilent)
      for (const auto& [speaker, lost] : agent.hears) add(speakers, speaker);
  for (const station::AgentTraffic& agent : report.agents) {
    if (agent.agent == own || agent.age > kSilent) continue;
    for (const auto& [speaker, lost] : agent.hears) {
      add(hearers, agent.agent);
      if (speaker != own) heard[agent.agent][speaker] = lost;
    }
  }
  if (report.links.empty() && heard.empty()) return {};
  HearingTable table{.speakers = speakers};
  for (const std::string& hearer : hearers) {
    table.cells.push_back({.hearer = hearer, .text = hearer});
    for (const std::string& speaker : speakers) {
      HearingCell cell{.hearer = hearer, .speaker = speaker};
      const auto row = heard.find(hearer);
      if (row != heard.end())
        if (const auto lost = row->second.find(speaker); lost != row->second.end()) mark(lost->second, cell);
      table.cells.push_back(std::move(cell));
    }
  }
  return table;
}

std::vector<BudgetPart> budget_parts(const station::AgentTraffic& traffic, double bandwidth) {
  std::vector<BudgetPart> parts;
  if (!(bandwidth > 0.0 && std::isfinite(bandwidth))) return parts;
  double end = 0.0, known = 0.0;
  const auto add = [&](const std::string& name, double bytes) {
    const double share = std::min(bytes * 8.0 / bandwidth, 1.0 - end);
    if (!(share > 0.0)) return;
    parts.push_back({name, end, share});
    end += share;
  };
  for (const char* name : kClasses)
    if (const auto found = traffic.classes_out.find(name); found != traffic.classes_out.end()) {
      add(name, found->second);
      if (found->second > 0.0) known += found->second;
    }
  add("other", traffic.total_out - known);
  return parts;
}

}  // namespace adit::gui

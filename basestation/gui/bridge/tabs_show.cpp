// SPDX-License-Identifier: Apache-2.0
// What the tabs show of the station's answers.
#include <algorithm>
#include <utility>

#include "basestation/gui/bridge/tabs.hpp"
#include "core/findings/stairs_data.hpp"

namespace adit::gui {
void TabState::show_tabs() {
  const auto open_findings = std::ranges::count_if(found_.findings, [](const station::FoundItem& item) {
    return item.verdict == station::Verdict::open && !item.withdrawn;
  });
  const auto staircases = std::ranges::count_if(stairs_report_.stairs, [](const station::StairsItem& item) {
    return item.verdict != station::Verdict::rejected;
  });
  const auto troubled = std::count_if(world_->robots.begin(), world_->robots.end(),
                                      [](const station::Robot& robot) { return !robot.troubles.empty(); });
  std::ptrdiff_t cameras = 0;
  for (const station::Robot& robot : world_->robots)
    cameras += std::ranges::count_if(robot.cameras, &station::CameraStatus::kept_on);
  const auto count = [](auto number) { return number > 0 ? QString::number(number) : QString(); };
  tabs_.show({{"log", "Log", "F2", QString(), false},
              {"findings", "Findings", "F3", count(open_findings), false},
              {"health", "Health", "F4", count(troubled), troubled > 0},
              {"network", "Network", "F5", QString(), false},
              {"stairs", "Stairs", "F6", count(staircases), false},
              {"cameras", "Cameras", "F7", count(cameras), false},
              {"settings", "Settings", "F8", QString(), false}});
}

void TabState::show_health() {
  const HealthTable table = health_table(health_, *world_);
  std::vector<QVariantList> columns, cells;
  for (const std::string& column : table.columns) columns.push_back({text_of(column)});
  for (const HealthCell& cell : table.cells) {
    const bool chosen =
        !cell.component.empty() && cell.robot == chosen_robot_ && cell.component == chosen_component_;
    cells.push_back({text_of(cell.robot + '\n' + cell.component), text_of(cell.robot),
                     text_of(cell.component), text_of(cell.text), text_of(cell.hint), text_of(cell.shape),
                     word_of(cell.token), cell.old, chosen});
  }
  columns_.show(std::move(columns));
  cells_.show(std::move(cells));
  chosen_ = health_detail(health_, *world_, chosen_robot_, chosen_component_);
}

QVariantMap TabState::chosen() const {
  return {{"title", text_of(chosen_.title)},
          {"text", text_of(chosen_.text)},
          {"mine", chosen_.mine},
          {"automatic", chosen_.automatic}};
}

void TabState::show_network() {
  std::vector<QVariantList> rows;
  for (const NetworkRow& row : network_rows(net_, world_->station)) {
    QVariantList parts;
    for (const BudgetPart& part : row.parts)
      parts.push_back(QVariantMap{{"name", text_of(part.name)}, {"from", part.from}, {"share", part.share}});
    rows.push_back({text_of(row.agent), text_of(row.loss), text_of(row.trip), text_of(row.rates),
                    text_of(row.queue), text_of(row.budget), row.share, text_of(row.dropped),
                    text_of(row.shape), word_of(row.token), QVariant(parts)});
  }
  network_.show(std::move(rows));
  const HearingTable table = hearing_table(net_, world_->station);
  std::vector<QVariantList> speakers, cells;
  for (const std::string& speaker : table.speakers) speakers.push_back({text_of(speaker)});
  for (const HearingCell& cell : table.cells)
    cells.push_back({text_of(cell.hearer + '\n' + cell.speaker),
                     text_of(cell.speaker.empty() ? cell.hearer : std::string()), text_of(cell.text),
                     text_of(cell.shape), word_of(cell.token)});
  speakers_.show(std::move(speakers));
  hearing_.show(std::move(cells));
  emit network_changed();
}

void TabState::show_findings() {
  std::vector<QVariantList> rows;
  for (const FoundRow& row : found_rows(found_, world_->station)) {
    const station::FoundItem& item = found_.findings[rows.size()];
    rows.push_back({row.number, text_of(row.importance), text_of(row.kind), text_of(row.robot),
                    text_of(row.place), text_of(row.age), text_of(row.text), text_of(row.note),
                    text_of(row.verdict), text_of(row.shape), word_of(row.token), row.withdrawn,
                    row.removable, photos_.thumbnail(item), text_of(row.photo_state)});
  }
  photos_.refresh();
  findings_.show(std::move(rows));
  missing_ = text_of(found_missing(found_));
  show_tabs();
  emit findings_changed();
  if (found_again_) find_later();
  const bool has_stairs = std::ranges::any_of(
      found_.findings, [](const station::FoundItem& item) { return item.kind == findings::kStairs; });
  if (has_stairs || !stairs_report_.stairs.empty()) ask_stairs();
}

void TabState::show_stairs() {
  std::vector<QVariantList> rows;
  for (const StairsRow& row : stairs_rows(stairs_report_))
    rows.push_back({row.number, text_of(row.direction), row.turn, text_of(row.steps), text_of(row.floors),
                    text_of(row.step), text_of(row.breadth), text_of(row.robots), text_of(row.verdict),
                    text_of(row.climbers), text_of(row.others), word_of(row.token)});
  stairs_.show(std::move(rows));
  unreadable_ = text_of(station::unreadable_text(stairs_report_));
  show_tabs();
  emit findings_changed();
  if (std::exchange(stairs_again_, false)) ask_stairs();
}

}  // namespace adit::gui

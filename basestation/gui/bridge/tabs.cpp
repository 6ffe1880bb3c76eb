// SPDX-License-Identifier: Apache-2.0
// What the operator does with the tabs, and what they ask the station.
#include "basestation/gui/bridge/tabs.hpp"

#include <QDateTime>
#include <QDir>
#include <QSaveFile>
#include <QStandardPaths>
#include <algorithm>
#include <utility>

#include "basestation/client/connection.hpp"
#include "basestation/client/paths.hpp"
#include "basestation/gui/scene/camera.hpp"
#include "basestation/model/found_file.hpp"

namespace adit::gui {
namespace {

constexpr int kPeriodMs = 1000;
constexpr int kFoundLaterMs = 300;

/// The keys F2 to F8 in their order, and the names of the tabs.
constexpr std::array kTabNames{"log", "findings", "health", "network", "stairs", "cameras", "settings"};

}  // namespace

TabState::TabState(CommandSink& sink, RowModel& log, QObject* parent)
    : QObject(parent),
      sink_(sink),
      log_(log, this),
      settings_(this),
      tabs_({"tab", "label", "key", "count", "alarm"}, this),
      columns_({"name"}, this),
      cells_({"cell", "robot", "component", "label", "hint", "shape", "token", "old", "chosen"}, this),
      network_({"agent", "loss", "trip", "rates", "queue", "budget", "share", "dropped", "shape", "token",
                "parts"},
               this),
      speakers_({"name"}, this),
      hearing_({"cell", "name", "label", "shape", "token"}, this),
      findings_({"number", "importance", "kind", "robot", "place", "age", "line", "note", "verdict", "shape",
                 "token", "withdrawn", "removable", "photo", "photoState"},
                this),
      stairs_({"number", "direction", "turn", "steps", "floors", "step", "breadth", "robots", "verdict",
               "climbers", "others", "token"},
              this),
      world_(std::make_shared<station::World>()),
      photos_(sink, found_, this) {
  timer_.setInterval(kPeriodMs);
  connect(&timer_, &QTimer::timeout, this, &TabState::ask);
  found_later_.setSingleShot(true);
  found_later_.setInterval(kFoundLaterMs);
  connect(&found_later_, &QTimer::timeout, this, &TabState::ask_findings);
  connect(&settings_, &WindowSettings::remark, this, &TabState::remark);
  show_tabs();
}

void TabState::show(const std::shared_ptr<const station::World>& world,
                    const std::vector<std::string>& selection, bool silent) {
  world_ = world;
  log_.set_selection(selection);
  if (!world_->station.empty()) {
    const bool is_back = std::exchange(silent_, silent) && !silent;
    if (is_back) photos_.try_again();
    if (is_back || world_->findings.changes != found_changes_) find_later();
    found_changes_ = world_->findings.changes;
  }
  show_tabs();
}

void TabState::add_notice(const station::Notice& notice) {
  if (notice.code == "found") find_later();  // A station of an earlier release counts no changes.
}

void TabState::add_command(const station::CommandEvent& event) {
  if (event.ended && event.line.starts_with("finding ")) find_later();
}

void TabState::find_later() {
  if (!found_later_.isActive()) found_later_.start();  // Changes that never pause do not put it off.
}

bool TabState::press_key(int key) {
  const int index = key - Qt::Key_F2;
  if (index < 0 || index >= static_cast<int>(kTabNames.size())) return false;
  toggle(QString::fromLatin1(kTabNames[static_cast<std::size_t>(index)]));
  return true;
}

void TabState::toggle(const QString& tab) {
  if (tab == "log") {
    log_open_ = !extra_.isEmpty() || !log_open_;
    extra_.clear();
  } else {
    extra_ = tab == extra_ ? QString() : tab;
  }
  noting_ = 0;
  photos_.close();
  problem_.clear();
  time_questions();
  show_tabs();
  emit opened();
  emit shown();
  ask();
  if (extra_ == "findings") ask_findings();
}

void TabState::time_questions() {
  const bool asks = extra_ == "health" || extra_ == "network" || extra_ == "stairs" || network_watchers_ > 0;
  if (asks && !timer_.isActive()) timer_.start();
  if (!asks) timer_.stop();
}

void TabState::watch_network(bool watch) {
  network_watchers_ += watch ? 1 : -1;
  time_questions();
  if (watch) ask();
}

bool TabState::close() {
  if (extra_.isEmpty()) return false;
  if (noting_ != 0) {
    endNote({}, false);
    return true;
  }
  toggle(extra_);
  return true;
}

template <class Report>
void TabState::ask_for(const char* line, Result<Report> (*read)(const station::CommandOutcome&), bool& asked,
                       Report& report, void (TabState::*show)()) {
  if (asked) return;
  asked = true;
  sink_.query(line, [this, read, &asked, &report, show](const station::CommandOutcome& outcome) {
    asked = false;
    Result<Report> answer = read(outcome);
    problem_ = answer ? QString() : text_of(answer.error().text).trimmed();
    if (answer) report = std::move(*answer);
    (this->*show)();
    emit shown();
  });
}

void TabState::ask() {
  if (extra_ == "health")
    ask_for("health", &station::health_of, health_asked_, health_, &TabState::show_health);
  if (extra_ == "network" || network_watchers_ > 0)
    ask_for("net", &station::network_of, network_asked_, net_, &TabState::show_network);
  if (extra_ == "stairs" && !stairs_asked_) ask_stairs();
}

void TabState::ask_stairs() {
  stairs_again_ = stairs_asked_;
  ask_for("stairs", &station::stairs_of, stairs_asked_, stairs_report_, &TabState::show_stairs);
}

void TabState::ask_findings() {
  found_again_ = found_asked_;  // What is under way may be older than what is wanted now.
  ask_for("findings", &station::findings_of, found_asked_, found_, &TabState::show_findings);
}

void TabState::choose(const QString& robot, const QString& component) {
  chosen_robot_ = robot.toStdString();
  chosen_component_ = component.toStdString();
  show_health();
  emit shown();
}

void TabState::restartChosen() {
  if (!chosen_.mine) return;
  emit ordered(text_of(station::client::quoted({"restart", chosen_robot_, chosen_component_})));
}

void TabState::changePolicy() {
  if (!chosen_.mine) return;
  emit ordered(text_of(station::client::quoted(
      {"policy", chosen_robot_, chosen_component_, chosen_.automatic ? "manual" : "auto"})));
}

void TabState::judge(int finding, const QString& verdict) {
  emit ordered(QString("finding %1 %2").arg(finding).arg(verdict));
}

void TabState::removeMark(int finding) { emit ordered(QString("finding remove %1").arg(finding)); }

void TabState::pickFinding(int finding) {
  picked_ = static_cast<std::uint32_t>(finding);
  emit shown();
  emit findings_changed();
  for (const station::FoundItem& item : found_.findings)
    if (item.number == picked_ && drawable(item.position[0], item.position[1]))
      emit place_wanted(item.position[0], item.position[1], item.position[2]);
}

void TabState::pickStairs(int number) {
  picked_ = static_cast<std::uint32_t>(number);
  emit shown();
  emit findings_changed();
  for (const station::StairsItem& item : stairs_report_.stairs) {
    if (item.number != picked_) continue;
    const Eigen::Vector3d middle = (item.stairs.foot + item.stairs.top()) / 2;
    if (drawable(middle.x(), middle.y())) emit place_wanted(middle.x(), middle.y(), item.stairs.foot.z());
  }
}

void TabState::show_finding(int finding) {
  picked_ = static_cast<std::uint32_t>(finding);
  const QString tab = picked_stairs_row() < 0 ? "findings" : "stairs";
  if (extra_ != tab) toggle(tab);
  emit shown();
  emit findings_changed();
}

int TabState::picked_row() const {
  for (std::size_t i = 0; i < found_.findings.size(); ++i)
    if (found_.findings[i].number == picked_) return static_cast<int>(i);
  return -1;
}

int TabState::picked_stairs_row() const {
  const auto& all = stairs_report_.stairs;
  const auto at = std::ranges::find(all, picked_, &station::StairsItem::number);
  return at == all.end() ? -1 : static_cast<int>(at - all.begin());
}

void TabState::startNote(int finding) {
  noting_ = finding;
  emit shown();
}

void TabState::endNote(const QString& text, bool send) {
  const int finding = std::exchange(noting_, 0);
  emit shown();
  if (!send || finding == 0) return;
  emit ordered(text_of(station::client::quoted(
      {"finding", std::to_string(finding), "note", text.simplified().toStdString()})));
}

void TabState::exportLog() { write("log.txt", log_.as_text().toUtf8()); }

void TabState::exportFindings() {
  write("findings.csv", QByteArray::fromStdString(station::found_csv(found_)));
  write("findings.geojson", QByteArray::fromStdString(station::found_geojson(found_)));
  write("findings.json", QByteArray::fromStdString(station::findings_text_of(found_)));
}

void TabState::write(const QString& name, const QByteArray& content) {
  QString folder = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
  if (folder.isEmpty() || !QDir(folder).exists()) {
    const auto state = station::client::state_folder();
    if (!state) return emit said(text_of(state.error().text), false);
    folder = text_of(*state);
  }
  const QString when = QDateTime::currentDateTime().toString("yyyyMMdd-HHmmss");
  QSaveFile file(folder + "/adit-" + when + "-" + name);
  const bool written =
      file.open(QIODevice::WriteOnly) && file.write(content) == content.size() && file.commit();
  emit said(written ? "written: " + file.fileName() : file.fileName() + ": " + file.errorString(), written);
}

}  // namespace adit::gui

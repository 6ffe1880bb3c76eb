// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/control.hpp"

#include <unistd.h>

#include <QDateTime>
#include <algorithm>
#include <cmath>

#include "basestation/gui/bridge/card.hpp"
#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/model/numbering.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::gui {
namespace {

using station::Robot;

QString names_of(const std::vector<std::string>& names) {
  QStringList list;
  for (const std::string& name : names) list << text_of(name);
  return list.join(" ");
}

QString word_of(Contact contact) {
  constexpr std::array kWords{"live", "stale", "lost"};
  return QString::fromLatin1(kWords[static_cast<std::size_t>(contact)]);
}

}  // namespace

QString Control::one_line(const std::string& text) {
  return text_of(text).split('\n', Qt::SkipEmptyParts).join(" · ");
}

Control::Control(CommandSink& sink, Orders orders, QObject* parent)
    : QObject(parent),
      sink_(sink),
      orders_(orders),
      world_(std::make_shared<station::World>()),
      map_(std::make_shared<station::TileMap>()),
      robots_({"name", "number", "glyph", "platform", "holder", "owner", "headline", "shortHeadline", "token",
               "shape", "detail", "shortDetail", "battery", "speed", "goal", "age", "contact", "selected"},
              this),
      buttons_(
          {"slot", "label", "key", "hint", "shortHint", "names", "possible", "touch", "state_", "reason"},
          this),
      refusals_({"row", "label", "names", "why", "cureLabel", "cureLine", "cureHold"}, this),
      log_({"row", "time", "kind", "who", "line"}, this),
      tabs_(sink, log_, this),
      feeds_(sink, this) {
  connect(&tabs_, &TabState::ordered, this, &Control::order_of_tab);
  connect(&tabs_, &TabState::place_wanted, this, &Control::look_at);
  connect(&tabs_, &TabState::remark, this, &Control::add_remark);
  // Who drives must see the map.
  connect(&drive_, &DriveControl::changed, &tabs_, [this] {
    if (drive_.driving()) tabs_.photos()->close();
  });
  connect(&drive_, &DriveControl::changed, &follow_, &MapFollow::refresh_drive);
  connect(&follow_, &MapFollow::drive_changed, this, [this](bool driving) {
    if (driving && tabs_.open() == "cameras") tabs_.close();
  });
  connect(&tabs_, &TabState::network_changed, &cameras_, &CameraGrid::refresh);
  connect(&tabs_, &TabState::findings_changed, this, &Control::stairs_shown);
  connect(this, &Control::shown, this, &Control::stairs_shown);
  connect(&tabs_, &TabState::said, this,
          [this](const QString& text, bool good) { say(text, good ? "done" : "refused"); });
  refresh();
}

void Control::show(std::shared_ptr<const station::World> world, double now) {
  now_ = now;
  world_ = std::move(world);
  silent_for_ = 0.0;
  trails_.add(*world_, now);
  if (catch_up_) {
    catch_up_ = false;
    std::uint64_t newest = 0;
    for (const station::Notice& notice : world_->notices) newest = std::max(newest, notice.id);
    if (newest < last_notice_) last_notice_ = 0;  // Another run of the station.
    for (const station::Notice& notice : world_->notices)
      if (notice.id > last_notice_) show_notice(notice);
  }
  refresh();
}

void Control::show_map(std::shared_ptr<const station::TileMap> map) {
  map_ = std::move(map);
  emit map_changed();
}

void Control::show_link(bool connected, double silent_for, const std::string& why) {
  const bool same = connected != ended_ && why == why_ && silent_for < 1.0 && silent_for_ < 1.0;
  ended_ = !connected;
  catch_up_ = catch_up_ || ended_;
  silent_for_ = silent_for;
  why_ = why;
  if (!same) refresh();  // While the station speaks, its snapshots refresh the window.
}

void Control::refresh() {
  show_cards();
  show_bar();
  attention_.refresh();
  details_.refresh();
  cameras_.refresh();
  area_.refresh();
  tabs_.show(world_, selection_, silent());
  emit shown();
}

void Control::show_cards() {
  std::vector<QVariantList> rows;
  mine_ = lost_ = stopped_ = 0;
  const std::vector<int> numbers = station::numbers_of(*world_);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Robot& robot = world_->robots[i];
    const Card card = card_of(robot, numbers[i], silent_for_, trails_.stale_after(robot.name));
    mine_ += robot.mine;
    lost_ += robot.lost;
    stopped_ += robot.stopped || !robot.stops.empty();
    const bool selected = std::find(selection_.begin(), selection_.end(), robot.name) != selection_.end();
    rows.push_back({text_of(card.name), card.number, text_of(card.glyph), text_of(card.platform),
                    text_of(card.holder), word_of(card.owner), text_of(card.headline),
                    text_of(card.short_headline), word_of(card.headline_token), text_of(card.shape),
                    text_of(card.detail), text_of(card.short_detail), text_of(card.battery),
                    text_of(card.speed), text_of(card.goal), text_of(card.age), word_of(card.contact),
                    selected});
  }
  robots_.show(std::move(rows));
}

void Control::show_bar() {
  bar_ = bar_of(*world_, selection_);
  if (silent()) {  // Only a stop has a way of its own.
    bar_.not_now.clear();
    if (!selection_.empty())
      bar_.not_now.push_back({.label = "All but stop",
                              .robots = names_of(selection_).toStdString(),
                              .why = "the station is silent"});
    for (BarButton& button : bar_.buttons)
      if (button.id != "stop") button.robots.clear(), button.hint.clear(), button.short_hint.clear();
  }
  std::vector<QVariantList> rows;
  for (const BarButton& button : bar_.buttons) {
    constexpr std::array kTouches{"tap", "hold", "place", "place_held"};
    const auto state = states_.find(button.id);
    rows.push_back({text_of(button.id), text_of(button.label), text_of(button.key), text_of(button.hint),
                    text_of(button.short_hint), names_of(button.robots), !button.robots.empty(),
                    QString::fromLatin1(kTouches[static_cast<std::size_t>(button.touch)]),
                    state == states_.end() ? QString() : state->second, reason_of(button)});
  }
  buttons_.show(std::move(rows));
  rows.clear();
  for (const Refusal& refusal : bar_.not_now)
    rows.push_back({static_cast<int>(rows.size()), text_of(refusal.label), text_of(refusal.robots),
                    text_of(refusal.why), text_of(refusal.cure_label), text_of(refusal.cure_line),
                    refusal.cure_hold});
  refusals_.show(std::move(rows));
}

QString Control::reason_of(const BarButton& button) const {
  if (!button.robots.empty()) return {};
  if (selection_.empty()) return "no robot is selected";
  for (const Refusal& refusal : bar_.not_now) {
    const QStringList labels = text_of(refusal.label).split(", ");
    if (labels.contains(text_of(button.label)) || refusal.label == "All but stop")
      return text_of(refusal.robots + ": " + refusal.why);
  }
  return "not heard yet";
}

QString Control::others() const {
  QStringList list;
  for (const station::StationSummary& station : world_->stations)
    if (!station.self)
      list << text_of(station.name + (station.lost ? " lost " : " ") + age_text(station.age + silent_for_));
  return list.join(", ");
}

QString Control::stop_text() const {
  const int all = robot_count();
  if (all == 0) return "no robot heard";
  const QString count = QString("%1/%2 stopped").arg(stopped_).arg(all);
  return stop_missing_.isEmpty() || stopped_ == all ? count
                                                    : count + ", no answer: " + stop_missing_.join(" ");
}

QString Control::stop_text_short() const {
  return stop_missing_.isEmpty() ? stop_text()
                                 : QString("%1/%2 stopped, no answer: %3 robots")
                                       .arg(stopped_)
                                       .arg(robot_count())
                                       .arg(stop_missing_.size());
}

QString Control::silent_text() const {
  if (ended_) return "NO STATION: " + text_of(why_.empty() ? "it ended" : why_) + ". All values are old.";
  if (silent_for_ > 1.0)
    return "STATION SILENT for " + text_of(age_text(silent_for_)) +
           ". All values are old; only stop is tried.";
  return text_of(why_);
}

QString Control::silent_text_short() const {
  return ended_ ? "NO STATION. All values are old." : silent_text().section(": ", 0, 0);
}

QString Control::selection_text() const { return names_of(selection_); }

int Control::refusal_count() const {
  QSet<QString> labels;
  for (const Refusal& refusal : bar_.not_now)
    for (const QString& label : text_of(refusal.label).split(", ")) labels.insert(label);
  return static_cast<int>(labels.size());
}

void Control::set_aiming(bool aiming) {
  if (assign(aiming_, aiming)) emit aiming_changed();
}

void Control::set_solid(bool solid) {
  if (!assign(solid_, solid)) return;
  drop_orders();
  emit solid_changed();
}

void Control::set_reasons_open(bool open) {
  if (assign(reasons_open_, open)) emit reasons_open_changed();
}

void Control::say(const QString& text, const QString& kind, const QString& brief) {
  outcome_ = text;
  outcome_short_ = brief.isEmpty() ? text : brief;
  outcome_kind_ = kind;
  emit said();
}

void Control::log_row(const QString& kind, const QString& who, const QString& text, double age) {
  constexpr double kLongest = 1e6;  // s
  const auto ago = static_cast<qint64>(1e3 * (age > 0.0 ? std::min(age, kLongest) : 0.0));
  const QString time = QDateTime::currentDateTime().addMSecs(-ago).toString("HH:mm:ss");
  log_.prepend({next_row_++, time, kind, who, text}, kMaxLog);
}

void Control::add_notice(const station::Notice& notice) {
  if (!catch_up_) show_notice(notice);  // Otherwise the next snapshot has it, too.
}

void Control::show_notice(const station::Notice& notice) {
  last_notice_ = std::max(last_notice_, notice.id);
  const bool urgent = attention_.add(notice) == station::Priority::act;
  if (urgent || (notice.code == "obstacle_near" && notice.robot == drive_.robot().toStdString()))
    drive_.warn_hand(urgent);
  tabs_.add_notice(notice);
  const QString kind = !notice.mine                                    ? "dim"
                       : notice.severity == station::Severity::error   ? "bad"
                       : notice.severity == station::Severity::warning ? "warn"
                                                                       : "text";
  log_row(kind, text_of(notice.robot), one_line(notice.text.empty() ? notice.code : notice.text), notice.age);
}

void Control::add_command(const station::CommandEvent& event) {
  tabs_.add_command(event);
  cameras_.add_command(event);
  if (event.query || !event.ended) return;
  const bool own = event.mine || event.pid == ::getpid();  // A stop uses a connection of its own.
  const QString who =
      own ? "here" : "in another " + text_of(event.front_end.empty() ? "program" : event.front_end);
  const QString answer = one_line(event.text + event.error);
  log_row(event.exit_code == station::kExitDone ? "ok" : "warn", who,
          text_of(event.line) + (answer.isEmpty() ? "" : "  →  " + answer));
}

void Control::add_remark(const QString& text) { log_row("dim", {}, text); }

}  // namespace adit::gui

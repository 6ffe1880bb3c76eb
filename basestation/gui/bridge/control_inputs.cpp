// SPDX-License-Identifier: Apache-2.0
// What the operator does: selecting, ordering, keys.
#include <algorithm>
#include <cmath>

#include "basestation/gui/break.hpp"
#include "basestation/gui/bridge/card.hpp"
#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/gui/scene/theme.hpp"
#include "basestation/model/exit_code.hpp"
#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

constexpr int kDoneShownMs = 1000, kRefusedShownMs = 8000;
constexpr int kConfirmMs = 3000;
constexpr double kGap = 0.5;  // Between robots that are sent to one place, m.

std::size_t slot_index(const char* id) {
  for (std::size_t i = 0; i < kSlots.size(); ++i)
    if (std::string(kSlots[i].id) == id) return i;
  return 0;
}

}  // namespace

void Control::select(const QString& name, bool add) {
  const std::string robot = name.toStdString();
  const auto known = std::find(selection_.begin(), selection_.end(), robot);
  if (!add)
    selection_ = {robot};
  else if (known != selection_.end())
    selection_.erase(known);
  else
    selection_.push_back(robot);
  drop_orders();
  refresh();
}

void Control::tap(const Target& target, bool add) {
  if (target.finding != 0) return tabs_.show_finding(static_cast<int>(target.finding));
  select(QString::fromStdString(target.robot), add);
}

void Control::select_and_show(const std::vector<std::string>& robots) {
  std::vector<std::string> known;
  Point sum{};
  int located = 0;
  for (const std::string& name : robots) {
    const station::Robot* robot = world_->robot(name);
    if (!robot) continue;
    known.push_back(name);
    if (!robot->located || !drawable(robot->x, robot->y)) continue;
    sum = {sum.x + robot->x, sum.y + robot->y};
    ++located;
  }
  if (known.empty()) return;
  selection_ = std::move(known);
  drop_orders();
  refresh();
  if (located > 0) emit look_at(sum.x / located, sum.y / located, std::nan(""));
}

void Control::order(const std::string& line, const std::string& slot, CommandSink::Done then) {
  pending_line_.clear();
  begin_batch();
  run(line, slot, std::move(then));
}

void Control::drive_selected() { trigger(static_cast<int>(slot_index("drive")), false); }

void Control::take_selected(bool held) {
  const std::size_t slot = slot_index("take");
  const BarButton& button = bar_.buttons[slot];
  const bool needs_hold = button.touch == Touch::hold && !button.robots.empty();
  if (held == needs_hold) return trigger(static_cast<int>(slot), held);
  if (needs_hold)
    say(QString::fromStdString(button.label + " " + button.hint) + ": keep the button held", "sent");
}

void Control::begin_batch() {
  ++batch_;
  batch_lines_.clear();
  batch_refused_ = false;
}

void Control::drop_orders() {
  pending_line_.clear();
  motion_key_ = 0;
  emit orders_dropped();
}

void Control::run(const std::string& line, const std::string& slot, CommandSink::Done then) {
  const int batch = batch_;
  say(QString::fromStdString(line) + "  …", "sent");
  set_state(slot, "sent");
  sink_.execute(line,
                [this, line, slot, batch, then = std::move(then)](const station::CommandOutcome& outcome) {
                  finished(line, slot, batch, outcome);
                  if (then) then(outcome);
                });
}

void Control::order_of_tab(const QString& line) {
  if (silent()) return say("Not sent, as the station is silent: " + line, "refused");
  drop_orders();
  order(line.toStdString());
}

void Control::stop(const std::vector<std::string>& robots) {
  begin_batch();
  const int batch = batch_;
  std::string line = "stop";
  if (robots.empty()) line += " all";
  for (const std::string& robot : robots) line += " " + robot;
  say(QString::fromStdString(line) + "  …", "sent");
  set_state(robots.empty() ? "" : "stop", "sent");
  sink_.stop(robots, [this, line, robots, batch](const station::CommandOutcome& outcome) {
    if (robots.empty()) {
      QStringList missing;
      for (const station::RobotAnswer& answer : outcome.answers)
        if (!answer.accepted) missing << QString::fromStdString(answer.robot);
      stop_missing_ = missing.join(" ");
    }
    finished(line, robots.empty() ? "" : "stop", batch, outcome);
  });
}

void Control::finished(const std::string& line, const std::string& slot, int batch,
                       const station::CommandOutcome& outcome) {
  const bool done = outcome.exit_code == station::kExitDone;
  set_state(slot, done ? "done" : "refused");
  QTimer::singleShot(done ? kDoneShownMs : kRefusedShownMs, this, [this, slot] {
    const auto state = states_.find(slot);  // A newer order of the same button may be under way.
    if (state != states_.end() && state->second != "sent") set_state(slot, {});
  });
  if (batch != batch_) {  // Another order came after it. A stop without the station is in no log yet.
    if (line.starts_with("stop")) add_remark(one_line(outcome.text + outcome.error));
    return;
  }
  const QString answer = one_line(outcome.text + outcome.error);
  batch_lines_ << (answer.isEmpty() ? QString::fromStdString(line) : answer);
  batch_refused_ = batch_refused_ || !done;
  say((batch_refused_ ? "" : "✓ ") + batch_lines_.join(" · "), batch_refused_ ? "refused" : "done");
  emit shown();
}

void Control::set_state(const std::string& slot, const QString& state) {
  if (slot.empty()) return;
  if (state.isEmpty())
    states_.erase(slot);
  else
    states_[slot] = state;
  show_bar();
}

void Control::trigger(int slot, bool held) {
  if (slot < 0 || slot >= static_cast<int>(bar_.buttons.size())) return;
  const BarButton button = bar_.buttons[static_cast<std::size_t>(slot)];
  pending_line_.clear();
  if (button.robots.empty())
    return say(QString::fromStdString(button.label) + ": " + reason_of(button), "refused");
  if (button.touch == Touch::place) {
    set_aiming(!aiming_);
    if (aiming_) say("Tap the place on the map for " + selection_text() + "; Esc takes it back.", "sent");
    return;
  }
  if (button.touch == Touch::hold && !held)
    return say(QString::fromStdString(button.label + " " + button.hint) + ": press and hold", "sent");
  if (button.id == "stop") return stop(button.robots);
  if (button.id == "drive") return drive_.begin(button.robots.front());
  order(button.line, button.id);
}

void Control::cure(int row, bool held) {
  if (row < 0 || row >= static_cast<int>(bar_.not_now.size())) return;
  const Refusal refusal = bar_.not_now[static_cast<std::size_t>(row)];
  if (refusal.cure_line.empty() || (refusal.cure_hold && !held)) return;
  order(refusal.cure_line, refusal.cure_line.starts_with("take") ? "take" : "reset");
}

void Control::stopAll() {
  drop_orders();
  stop_missing_.clear();
  set_aiming(false);
  if constexpr (kBreakStopConfirm) return pend("stop all", "stop");
  stop({});
}

std::vector<Point> Control::goals_at(const Point& place) const {
  const BarButton& button = bar_.buttons[slot_index("goto")];
  double spacing = 0.0;
  for (const std::string& name : button.robots)
    if (const station::Robot* robot = world_->robot(name)) {
      const double extent = std::max(robot->size.length, robot->size.width);
      spacing = std::max(spacing, extent > 0.0 && extent < 50.0 ? extent : 1.0);
    }
  return spread(place, button.robots.size(), spacing + kGap);
}

void Control::go_to(const Point& place, std::optional<double> z) {
  const BarButton button = bar_.buttons[slot_index("goto")];
  set_aiming(false);
  pending_line_.clear();
  if (button.robots.empty()) return say("Go to: " + reason_of(button), "refused");
  const std::vector<Point> goals = goals_at(place);
  begin_batch();
  for (std::size_t i = 0; i < button.robots.size(); ++i)
    run("goto " + button.robots[i] + " " + station::fixed(goals[i].x, 2) + " " +
            station::fixed(goals[i].y, 2) + (z ? " " + station::fixed(*z, 2) : ""),
        "goto");
}

void Control::pend(const std::string& line, const std::string& slot) {
  pending_line_ = line;
  pending_slot_ = slot;
  pending_since_.start();
  say("Press Enter within 3 s: " + QString::fromStdString(line), "sent");
}

void Control::press_slot(const char* id) {
  const std::size_t index = slot_index(id);
  const BarButton& button = bar_.buttons[index];
  if (button.touch == Touch::hold && !button.robots.empty()) return pend(button.line, button.id);
  trigger(static_cast<int>(index), false);
}

void Control::move_selection(int by) {
  if (world_->robots.empty()) return;
  const int count = static_cast<int>(world_->robots.size());
  int at = by > 0 ? -1 : count;
  for (int i = 0; i < count; ++i)
    if (!selection_.empty() && world_->robots[static_cast<std::size_t>(i)].name == selection_.back()) at = i;
  at = std::clamp(at + by, 0, count - 1);
  select(QString::fromStdString(world_->robots[static_cast<std::size_t>(at)].name), false);
}

bool Control::pressKey(int key, int modifiers, int scan, bool repeated) {
  const bool shift = (modifiers & Qt::ShiftModifier) != 0, control = (modifiers & Qt::ControlModifier) != 0;
  if (key == Qt::Key_Pause || (key == Qt::Key_S && shift)) {
    if (!repeated) stopAll();
    return true;
  }
  motion_key_ = 0;
  if (drive_.driving() && (modifiers & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) == 0) {
    if (repeated) return true;
    if (drive_.press(key)) return true;
  }
  if (key == Qt::Key_Up || key == Qt::Key_Down) {
    move_selection(key == Qt::Key_Up ? -1 : 1);
    return true;
  }
  if (repeated || key == Qt::Key_Shift || key == Qt::Key_Control) return false;
  if (key == Qt::Key_Tab) {
    attention_.show_next();
    return true;
  }
  if ((modifiers & (Qt::AltModifier | Qt::MetaModifier)) != 0) return false;
  motion_key_ = 0;
  keys_down_.insert(key);
  if (control && key == Qt::Key_L) {
    Theme::instance().set_light(!Theme::instance().light());
    return true;
  }
  if (key == Qt::Key_Colon || (control && key == Qt::Key_K)) {
    command_line_.set_open(true);
    return true;
  }
  if (control) return false;
  if (tabs_.press_key(key)) return true;
  constexpr int kScanOf1 = 10;  // X11 and Wayland number the keys 1 to 9 from here.
  const int digit = key >= Qt::Key_1 && key <= Qt::Key_9               ? key - Qt::Key_1
                    : shift && scan >= kScanOf1 && scan < kScanOf1 + 9 ? scan - kScanOf1
                                                                       : -1;
  if (digit >= 0) {
    if (digit < robot_count())
      select(QString::fromStdString(world_->robots[static_cast<std::size_t>(digit)].name), shift);
    return true;
  }
  if (key == Qt::Key_V) {
    set_solid(!solid_);
    return true;
  }
  if (key == Qt::Key_PageUp || key == Qt::Key_PageDown) {
    emit cut_moved(key == Qt::Key_PageUp ? 1 : -1);
    return true;
  }
  if (key == Qt::Key_I) {
    details_.set_open(!details_.is_open());
    return true;
  }
  if (key == Qt::Key_Return || key == Qt::Key_Enter) {
    const bool in_time = !pending_line_.empty() && pending_since_.elapsed() <= kConfirmMs;
    const std::string line = std::exchange(pending_line_, {});
    if (!in_time) return !line.empty();
    if (silent()) {
      say("Not sent, as the station is silent: " + QString::fromStdString(line), "refused");
      return true;
    }
    begin_batch();
    run(line, pending_slot_);
    return true;
  }
  if (key == Qt::Key_Escape) {
    emit orders_dropped();
    if (area_.active()) {
      area_.set_active(false);
    } else if (aiming_ || reasons_open_ || attention_.is_open() || !pending_line_.empty()) {
      if (aiming_ || !pending_line_.empty()) say("Taken back.", "sent");
      set_aiming(false);
      set_reasons_open(false);
      attention_.set_open(false);
      pending_line_.clear();
    } else if (!tabs_.close()) {
      selection_.clear();
      refresh();
    }
    return true;
  }
  if (key == Qt::Key_E && shift) {
    std::string line = "reset";
    for (const std::string& name : selection_)
      if (const station::Robot* robot = world_->robot(name); robot && robot->mine && !robot->stops.empty())
        line += " " + name;
    if (line == "reset")
      say("Reset: no stop is set at a robot of yours in the selection", "refused");
    else
      pend(line + " --override", "reset");
    return true;
  }
  return press_letter(key);
}

bool Control::press_letter(int key) {
  for (const Slot& slot : kSlots) {
    if (*slot.key == 0 || key != Qt::Key_A + (*slot.key - 'a')) continue;
    if (!slot.motion)
      press_slot(slot.id);
    else if (keys_down_.size() == 1)
      motion_key_ = key;  // It may start motion: it acts when it is released, and alone.
    return true;
  }
  return false;
}

bool Control::releaseKey(int key, bool repeated) {
  if (repeated) return false;
  drive_.release_key(key);
  keys_down_.remove(key);
  if (key != motion_key_) return false;
  motion_key_ = 0;
  for (const Slot& slot : kSlots)
    if (*slot.key != 0 && slot.motion && key == Qt::Key_A + (*slot.key - 'a')) press_slot(slot.id);
  return true;
}

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
// What the operator does: selecting, ordering, keys.
#include <algorithm>
#include <array>
#include <cmath>

#include "basestation/gui/break.hpp"
#include "basestation/gui/bridge/card.hpp"
#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/gui/scene/theme.hpp"
#include "basestation/model/numbering.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

constexpr int kDoneShownMs = 1000, kRefusedShownMs = 8000;
constexpr int kConfirmMs = 3000;
constexpr double kZoomStep = 1.25;
constexpr double kGap = 0.5;  // Between robots that are sent to one place, m.

bool is_modifier(int key) {
  return (key >= Qt::Key_Shift && key <= Qt::Key_ScrollLock) || key == Qt::Key_AltGr ||
         key == Qt::Key_Super_L || key == Qt::Key_Super_R;
}

/// The place of a key on the keyboard: its character at the release may be another one than at the press. The
/// scan code, or the character where the platform has no scan codes.
int place_of(int key, int scan) { return scan != 0 ? scan : -key; }

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
  if (target.finding != 0 && view_only()) return;  // There is no tab for it.
  if (target.finding != 0) return tabs_.show_finding(static_cast<int>(target.finding));
  select(text_of(target.robot), add);
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
    say(text_of(button.label + " " + button.hint) + ": keep the button held", "sent",
        text_of(button.label + " " + button.short_hint) + ": keep the button held");
}

void Control::begin_batch() {
  ++batch_;
  batch_lines_.clear();
  batch_refused_ = false;
}

void Control::drop_orders() {
  pending_line_.clear();
  motion_place_ = 0;
  emit orders_dropped();
}

void Control::run(const std::string& line, const std::string& slot, CommandSink::Done then) {
  if (view_only() && !line.starts_with("camera "))
    return say("Not sent, as this window only shows: " + text_of(line), "refused");
  const int batch = batch_;
  say(text_of(line) + "  …", "sent", text_of(line.substr(0, line.find(' '))) + "  …");
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
  say(text_of(line) + "  …", "sent", "stop  …");
  set_state(robots.empty() ? "" : "stop", "sent");
  sink_.stop(robots, [this, line, robots, batch](const station::CommandOutcome& outcome) {
    if (robots.empty()) {
      stop_missing_.clear();
      for (const station::RobotAnswer& answer : outcome.answers)
        if (!answer.accepted) stop_missing_ << text_of(answer.robot);
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
  batch_lines_ << (answer.isEmpty() ? text_of(line) : answer);
  batch_refused_ = batch_refused_ || !done;
  const QString first_word = text_of(line.substr(0, line.find(' ')));
  if (batch_refused_)
    say(batch_lines_.join(" · "), "refused",
        first_word + ": refused or without an answer, the log says by whom");
  else
    say("✓ " + batch_lines_.join(" · "), "done", first_word + ": done, the log has the answers");
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
  if (button.robots.empty()) return say(text_of(button.label) + ": " + reason_of(button), "refused");
  if (button.touch == Touch::place || button.touch == Touch::place_held) {
    set_aiming(!aiming_);
    if (aiming_) ask_for_place(button);
    return;
  }
  if (button.touch == Touch::hold && !held)
    return say(text_of(button.label + " " + button.hint) + ": press and hold", "sent",
               text_of(button.label + " " + button.short_hint) + ": press and hold");
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
  if constexpr (kBreakStopConfirm) return pend({.id = "stop", .label = "Stop all", .line = "stop all"});
  stop({});
}

std::vector<Point> Control::goals_at(const Point& place) const {
  if (view_only()) return {};
  const BarButton& button = bar_.buttons[slot_index("goto")];
  double spacing = 0.0;
  for (const std::string& name : button.robots)
    if (const station::Robot* robot = world_->robot(name)) {
      const double extent = std::max(robot->size.length, robot->size.width);
      spacing = std::max(spacing, extent > 0.0 && extent < 50.0 ? extent : 1.0);
    }
  return spread(place, button.robots.size(), spacing + kGap);
}

bool Control::goto_is_held() const {
  return !view_only() && bar_.buttons[slot_index("goto")].touch == Touch::place_held;
}

void Control::ask_for_place(const BarButton& button) {
  const QString how =
      goto_is_held() ? "Press and hold the place on the map for " : "Tap the place on the map for ";
  say(how + text_of(words_of(button.robots)) + "; Esc takes it back.", "sent",
      how + QString::number(button.robots.size()) + " robots; Esc takes it back.");
}

void Control::go_to(const Point& place, std::optional<double> z, bool held) {
  if (view_only()) return;
  const BarButton button = bar_.buttons[slot_index("goto")];
  if (selection_.empty() && !aiming_) return mark_.choose(place, z);  // There is no other action at a place.
  if (goto_is_held() && !held) return ask_for_place(button);
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

StairsOffer Control::offer_of_stairs() const {
  const auto& all = tabs_.staircases().stairs;
  const auto picked = std::ranges::find(all, tabs_.picked(), &station::StairsItem::number);
  const BarButton& button = bar_.buttons[slot_index("goto")];
  return stairs_offer(picked == all.end() ? nullptr : &*picked, selection_, button.robots,
                      reason_of(button).toStdString());
}

QString Control::stairs_text() const { return text_of(offer_of_stairs().text); }

bool Control::stairs_offered() const { return !offer_of_stairs().robot.empty(); }

void Control::goOverStairs(bool up, bool held) {
  const StairsOffer offer = offer_of_stairs();
  if (offer.robot.empty()) return say(text_of(offer.text), "refused");
  if (goto_is_held() && !held) return say("Press and hold: " + text_of(offer.text), "sent");
  order("stairs go " + offer.robot + " " + std::to_string(tabs_.picked()) + (up ? " up" : " down"), "goto");
}

void Control::pend(const BarButton& button) {
  pending_line_ = button.line;
  pending_slot_ = button.id;
  pending_since_.start();
  const QString asks = "Press Enter within 3 s: ";
  say(asks + text_of(button.line), "sent", asks + text_of(button.label + " " + button.short_hint));
}

void Control::press_slot(const char* id) {
  const std::size_t index = slot_index(id);
  const BarButton& button = bar_.buttons[index];
  if (button.touch == Touch::hold && !button.robots.empty()) return pend(button);
  trigger(static_cast<int>(index), false);
}

void Control::move_selection(int by) {
  if (world_->robots.empty()) return;
  const int count = static_cast<int>(world_->robots.size());
  int at = by > 0 ? -1 : count;
  for (int i = 0; i < count; ++i)
    if (!selection_.empty() && world_->robots[static_cast<std::size_t>(i)].name == selection_.back()) at = i;
  at = std::clamp(at + by, 0, count - 1);
  select(text_of(world_->robots[static_cast<std::size_t>(at)].name), false);
}

/// What a key does that is pressed. The first row that fits counts.
struct Control::KeyRow {
  int key{};
  int with{};      ///< Of Shift and Ctrl, those that must be down.
  bool repeats{};  ///< It acts again while it is held.
  bool views{};    ///< It changes the view alone.
  void (*act)(Control& control){};
};

std::span<const Control::KeyRow> Control::keys() {
  static constexpr std::array kKeys{
      KeyRow{Qt::Key_Up, 0, true, true, [](Control& c) { c.move_selection(-1); }},
      KeyRow{Qt::Key_Down, 0, true, true, [](Control& c) { c.move_selection(1); }},
      KeyRow{Qt::Key_Left, 0, false, true, [](Control& c) { c.cameras_.step(-1); }},
      KeyRow{Qt::Key_Right, 0, false, true, [](Control& c) { c.cameras_.step(1); }},
      KeyRow{Qt::Key_Tab, 0, false, true, [](Control& c) { c.attention_.show_next(); }},
      KeyRow{Qt::Key_L, Qt::ControlModifier, false, true,
             [](Control&) { Theme::instance().set_light(!Theme::instance().light()); }},
      KeyRow{Qt::Key_K, Qt::ControlModifier, false, false,
             [](Control& c) { c.command_line_.set_open(true); }},
      KeyRow{Qt::Key_Colon, 0, false, false, [](Control& c) { c.command_line_.set_open(true); }},
      KeyRow{Qt::Key_V, 0, false, true, [](Control& c) { c.set_solid(!c.solid_); }},
      KeyRow{Qt::Key_F, 0, false, true, [](Control& c) { c.follow_.toggle(); }},
      KeyRow{Qt::Key_U, 0, false, true, [](Control& c) { c.follow_.toggleHeading(); }},
      KeyRow{Qt::Key_Plus, 0, true, true, [](Control& c) { emit c.zoomed(kZoomStep); }},
      KeyRow{Qt::Key_Equal, 0, true, true, [](Control& c) { emit c.zoomed(kZoomStep); }},
      KeyRow{Qt::Key_Minus, 0, true, true, [](Control& c) { emit c.zoomed(1.0 / kZoomStep); }},
      KeyRow{Qt::Key_PageUp, 0, false, true, [](Control& c) { emit c.cut_moved(1); }},
      KeyRow{Qt::Key_PageDown, 0, false, true, [](Control& c) { emit c.cut_moved(-1); }},
      KeyRow{Qt::Key_I, 0, false, false, [](Control& c) { c.details_.set_open(!c.details_.is_open()); }},
      KeyRow{Qt::Key_C, 0, false, false,
             [](Control& c) {
               const bool shown = c.details_.is_open() && c.details_.camera_on();
               c.details_.set_camera_on(!shown);
               if (!shown) c.details_.set_open(true);
             }},
      KeyRow{Qt::Key_Return, 0, false, false, [](Control& c) { c.confirm(); }},
      KeyRow{Qt::Key_Enter, 0, false, false, [](Control& c) { c.confirm(); }},
      KeyRow{Qt::Key_Escape, 0, false, true, [](Control& c) { c.take_back(); }},
      KeyRow{Qt::Key_E, Qt::ShiftModifier, false, false, [](Control& c) { c.pend_override(); }},
  };
  return kKeys;
}

bool Control::pressKey(int key, int modifiers, int scan, bool repeated) {
  const bool shift = (modifiers & Qt::ShiftModifier) != 0;
  if (key == Qt::Key_Pause || (key == Qt::Key_S && shift)) {  // In every state, with any other key.
    if (!repeated) stopAll();
    return true;
  }
  motion_place_ = 0;  // A press that repeats is no tap, and one of another key takes it back.
  if (is_modifier(key)) return false;
  const int place = place_of(key, scan);
  const bool alone = keys_down_.isEmpty();
  if (!repeated) keys_down_.insert(place);
  const int command = modifiers & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier);
  if (drive_.driving() && command == 0 && (repeated || drive_.press(key, place))) return true;
  for (const KeyRow& row : keys()) {
    const int wanted = row.with & Qt::ControlModifier;
    if (row.key != key || command != wanted || (row.with & ~modifiers) != 0) continue;
    if ((repeated && !row.repeats) || (view_only() && !row.views)) return false;
    row.act(*this);
    return true;
  }
  if (repeated || command != 0) return false;
  if (view_only()) return press_digit(key, scan, shift);
  return tabs_.press_key(key) || press_digit(key, scan, shift) || press_letter(key, place, alone);
}

void Control::confirm() {
  const bool in_time = !pending_line_.empty() && pending_since_.elapsed() <= kConfirmMs;
  const std::string line = std::exchange(pending_line_, {});
  if (!in_time) return;
  if (silent()) return say("Not sent, as the station is silent: " + text_of(line), "refused");
  order(line, pending_slot_);
}

void Control::take_back() {
  emit orders_dropped();
  if (tabs_.photos()->close()) return;
  if (area_.active()) {
    area_.set_active(false);
  } else if (mark_.active() || mark_.ready()) {
    mark_.drop();
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
}

void Control::pend_override() {
  std::vector<std::string> robots;
  for (const std::string& name : selection_)
    if (const station::Robot* robot = world_->robot(name); robot && robot->mine && !robot->stops.empty())
      robots.push_back(name);
  if (robots.empty()) return say("Reset: no stop is set at a robot of yours in the selection", "refused");
  pend({.id = "reset", .line = "reset " + words_of(robots) + " --override", .robots = robots});
}

bool Control::press_digit(int key, int scan, bool add) {
  constexpr int kScanOf1 = 10;  // X11 and Wayland number the keys 1 to 9 from here.
  const int digit = key >= Qt::Key_1 && key <= Qt::Key_9             ? key - Qt::Key_0
                    : add && scan >= kScanOf1 && scan < kScanOf1 + 9 ? scan - kScanOf1 + 1
                                                                     : 0;
  if (digit == 0) return false;
  if (const station::Robot* robot = station::robot_with_number(*world_, digit))
    select(text_of(robot->name), add);
  return true;
}

bool Control::press_letter(int key, int place, bool alone) {
  for (const Slot& slot : kSlots) {
    if (*slot.key == 0 || key != Qt::Key_A + (*slot.key - 'a')) continue;
    if (!slot.motion)
      press_slot(slot.id);
    else if (alone)  // It may start motion: it acts when it is released.
      motion_place_ = place, motion_slot_ = slot.id;
    return true;
  }
  return false;
}

bool Control::releaseKey(int key, int scan, bool repeated) {
  if (repeated) return false;
  const int place = place_of(key, scan);
  drive_.release_key(place);
  // Without scan codes, a key that changed its character since its press is not known at its release.
  if (!keys_down_.remove(place) && scan == 0 && !is_modifier(key)) forgetKeys();
  if (place == 0 || place != motion_place_) return false;
  motion_place_ = 0;
  press_slot(motion_slot_);
  return true;
}

void Control::forgetKeys() {
  keys_down_.clear();
  motion_place_ = 0;
  drive_.forget_keys();
}

void Control::setFocused(bool focused) {
  forgetKeys();
  drive_.set_focused(focused);
}

}  // namespace adit::gui

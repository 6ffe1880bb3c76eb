// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/command_line.hpp"

#include <algorithm>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::gui {

CommandLine::CommandLine(Control& control) : QObject(&control), control_(control) {}

void CommandLine::set_open(bool open) {
  if (!assign(open_, open)) return;
  if (open_) {
    show_answer({}, false);
    set_line({});
  }
  emit open_changed();
}

std::vector<std::string> CommandLine::robots() const {
  std::vector<std::string> names;
  for (const station::Robot& robot : control_.world().robots) names.push_back(robot.name);
  return names;
}

void CommandLine::set_line(const QString& line) {
  line_ = line;
  typed_ = read_line(line.trimmed().toStdString());
  proposals_.clear();
  for (const std::string& word : gui::proposals(line.toStdString(), robots())) proposals_ << text_of(word);
  emit line_changed();
}

void CommandLine::complete() { set_line(text_of(completed(line_.toStdString(), robots()))); }

void CommandLine::take(const QString& word) {
  set_line(text_of(with_word(line_.toStdString(), word.toStdString())));
}

void CommandLine::recall(int by) {
  const int count = static_cast<int>(history_.size());
  at_ = std::clamp(at_ + by, 0, count);
  set_line(at_ < count ? history_[at_] : QString());
}

void CommandLine::show_answer(const QString& text, bool refused) {
  answer_ = text.size() > kMaxAnswer ? text.left(kMaxAnswer) + "\n…" : text;
  refused_ = refused;
  emit answered();
}

bool CommandLine::is_held() const { return typed_.is_held(control_.world().robots.size()); }

void CommandLine::run(bool held) {
  if (is_held() && !held) return show_answer("press and hold: it commands more than three robots", false);
  const std::string line = line_.trimmed().toStdString();
  const TypedLine typed = typed_;
  const int order = ++orders_;
  if (typed.kind == TypedLine::Kind::nothing) return;
  if (typed.kind == TypedLine::Kind::wrong || typed.kind == TypedLine::Kind::help)
    return show_answer(text_of(typed.text), typed.kind == TypedLine::Kind::wrong);
  if (history_.isEmpty() || history_.back() != line_.trimmed()) history_ << line_.trimmed();
  while (history_.size() > kMaxHistory) history_.removeFirst();
  at_ = static_cast<int>(history_.size());
  set_line({});
  if (typed.kind == TypedLine::Kind::stop) {
    show_answer("the answer to a stop is shown above", false);
    return typed.robots.empty() ? control_.stopAll() : control_.stop(typed.robots);
  }
  if (control_.silent()) return show_answer("Not sent, as the station is silent.", true);
  show_answer("…", false);
  control_.order(line, {}, [this, order](const station::CommandOutcome& outcome) {
    if (order == orders_)
      show_answer(text_of(outcome.text + outcome.error).trimmed(), outcome.exit_code != station::kExitDone);
  });
}

}  // namespace adit::gui

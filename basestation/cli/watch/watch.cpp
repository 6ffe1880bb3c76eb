// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <map>

#include "basestation/cli/interrupt.hpp"
#include "basestation/cli/run_line.hpp"
#include "basestation/cli/terminal/terminal.hpp"
#include "basestation/cli/watch/render.hpp"
#include "basestation/input/key_stick.hpp"
#include "basestation/input/keys.hpp"
#include "basestation/model/numbering.hpp"

namespace adit::station::cli {
namespace {

using namespace input;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kDrawPeriod = 100ms;

class Dashboard {
 public:
  Dashboard(client::Connection& client, Terminal& terminal) : client_(client), terminal_(terminal) {
    client_.on_world = [this](const World& world) {
      world_ = world;
      heard_ = Clock::now();
      dirty_ = true;
      const auto names = names_of(world_);
      if (std::find(names.begin(), names.end(), state_.selected) == names.end())
        state_.selected = names.empty() ? "" : names.front();
    };
    client_.on_outcome = [this](std::int64_t id, const CommandOutcome& outcome) { ended(id, outcome); };
    client_.on_command = [this](const CommandEvent& event) {
      const std::string text = command_of_another(event);
      if (text.empty()) return;
      others_.push_back({Clock::now(), text});
      if (others_.size() > 30) others_.pop_front();
      dirty_ = true;
    };
    client_.notices();
    client_.follow();
  }

  /// Returns false if the connection to the station was lost.
  bool run() {
    while (!leaving_) {
      for (const int key : decode_keys(terminal_.read())) press(key);
      if (interrupted()) leaving_ = true;
      if (resized()) dirty_ = redraw_ = true;
      const auto now = Clock::now();
      const bool silent = now - heard_ > 2s;
      dirty_ = dirty_ || silent != state_.silent;
      state_.silent = silent;
      if (state_.driving && now >= next_stick_) {
        const auto v = stick_.velocity(now);
        client_.stick(drive_, v[0], v[1], v[2]);
        next_stick_ = now + 50ms;
        state_.driving_text = number(v[0]) + " m/s " + number(v[2]) + " rad/s";
        dirty_ = true;
      }
      // A page may take long on a slow connection, and the keys wait for it.
      if (dirty_ && now >= next_draw_) {
        draw();
        next_draw_ = now + kDrawPeriod;
      }
      if (!client_.wait(state_.driving ? 50 : dirty_ ? 100 : 200, STDIN_FILENO)) return false;
    }
    if (state_.driving) client_.cancel(drive_);
    return true;
  }

 private:
  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
  }

  void draw() {
    dirty_ = false;
    const auto lines = render(with_others(), state_, terminal_.rows(), terminal_.columns(), true);
    std::string out = redraw_ ? "\x1b[2J" : "";
    redraw_ = false;
    for (std::size_t i = 0; i < lines.size(); ++i)
      out += "\x1b[" + std::to_string(i + 1) + ";1H" + lines[i] + "\x1b[K";
    terminal_.write(out);
  }

  /// The world with the commands of other front ends merged into its notices, by age.
  World with_others() const {
    World world = world_;
    for (const auto& [when, text] : others_)
      world.notices.push_back(
          {{.text = text}, 0, std::chrono::duration<double>(Clock::now() - when).count(), true});
    std::ranges::stable_sort(world.notices, std::ranges::greater{}, &Notice::age);
    return world;
  }

  void say(const std::string& text, bool refused) {
    state_.message = text;
    state_.refused = refused;
    dirty_ = true;
  }

  void execute(const std::string& line) {
    asked_[client_.execute(line)] = line;
    say(line + " ...", false);
  }

  void ended(std::int64_t id, const CommandOutcome& outcome) {
    std::string text = outcome.error + outcome.text;
    std::replace(text.begin(), text.end(), '\n', ' ');
    if (id == drive_ && state_.driving) {
      state_.driving = false;
      return say(text, outcome.exit_code != kExitDone);
    }
    const auto found = asked_.find(id);
    if (found == asked_.end()) return;
    say(found->second + " -> " + text, outcome.exit_code != kExitDone);
    asked_.erase(found);
  }

  void select(int step) {
    const auto names = names_of(world_);
    const auto at = std::find(names.begin(), names.end(), state_.selected);
    if (names.empty()) return;
    const auto last = static_cast<std::ptrdiff_t>(names.size()) - 1;
    const auto next = std::clamp<std::ptrdiff_t>(at == names.end() ? 0 : at - names.begin() + step, 0, last);
    state_.selected = names[static_cast<std::size_t>(next)];
  }

  void press(int key) {
    dirty_ = true;
    if (key == key_interrupt) {
      leaving_ = true;
    } else if (state_.typing) {
      type(key);
    } else if (state_.driving) {
      if (key == key_escape || key == 'm') {
        client_.cancel(drive_);
      } else if (key == 'S' || key == 'x') {
        execute(key == 'S' ? "stop all" : "stop " + state_.selected);
      } else {
        stick_.press(key, Clock::now());
      }
    } else if (key == 'q' || key == 'Q') {
      leaving_ = true;
    } else if (key == '?' || key == key_escape) {
      state_.help = key == '?' && !state_.help;
    } else if (key == ':') {
      state_.typing = true;
    } else if (key == 'S') {
      execute("stop all");
    } else if (key == key_up || key == key_down) {
      select(key == key_up ? -1 : 1);
    } else if (key >= '1' && key <= '9') {
      if (const Robot* robot = robot_with_number(world_, key - '0')) state_.selected = robot->name;
    } else if (!state_.selected.empty()) {
      command(key);
    }
  }

  void command(int key) {
    const std::string& name = state_.selected;
    const Robot* view = world_.robot(name);
    if (key == 'g') {
      state_.typing = true;
      state_.line = "goto " + name + " ";
    } else if (key == 'm') {
      if (view) stick_.set_limits(view->max_speed, view->max_turn);
      drive_ = client_.teleop(name);
      state_.driving = true;
      say("", false);
    }
    struct Order {
      int key{};
      const char *verb{}, *after{};
    };
    for (const Order& order :
         {Order{'t', "take ", ""}, Order{'r', "release ", ""},
          Order{'l', view && view->locked ? "unlock " : "lock ", ""}, Order{'s', "stop ", ""},
          Order{'e', "reset ", ""}, Order{'E', "reset ", " --override"}, Order{'h', "mode ", " hold"},
          Order{'w', "mode ", " waypoint"}})
      if (order.key == key) execute(order.verb + name + order.after);
  }

  void type(int key) {
    if (key == key_escape || (key == key_backspace && state_.line.empty())) {
      state_.typing = false;
      state_.line.clear();
    } else if (key == key_enter) {
      state_.typing = false;
      if (!state_.line.empty()) execute(state_.line);
      state_.line.clear();
    } else if (key == key_backspace) {
      state_.line.pop_back();
    } else if (key < 127 && state_.line.size() < 200) {
      state_.line += static_cast<char>(key);
    }
  }

  client::Connection& client_;
  Terminal& terminal_;
  World world_{};
  WatchState state_{};
  KeyStick stick_{};
  std::map<std::int64_t, std::string> asked_{};
  std::deque<std::pair<Clock::time_point, std::string>> others_{};
  std::int64_t drive_{};
  Clock::time_point heard_{Clock::now()};
  Clock::time_point next_stick_{}, next_draw_{};
  bool dirty_{true};
  bool redraw_{true};
  bool leaving_{false};
};

}  // namespace

int watch(client::Connection& client, const Options& options) {
  bool good = true;
  {
    Terminal terminal(true);
    if (!terminal.usable())
      return fail(options, kExitUsage,
                  {Reason::bad_argument, "watch wants a terminal; in a script use --json status"});
    good = Dashboard(client, terminal).run();
  }
  if (good) return kExitDone;
  return fail(options, kExitNoAnswer, {Reason::no_answer, client.gone()});
}

}  // namespace adit::station::cli

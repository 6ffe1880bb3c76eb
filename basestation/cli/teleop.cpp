// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "basestation/cli/interrupt.hpp"
#include "basestation/cli/run_line.hpp"
#include "basestation/cli/terminal/terminal.hpp"
#include "basestation/input/gamepad.hpp"
#include "basestation/input/key_stick.hpp"
#include "basestation/input/keys.hpp"

namespace adit::station::cli {
namespace {

using input::decode_keys;
using input::Gamepad;
using input::KeyStick;
using Clock = KeyStick::Clock;

constexpr double kUnknownLimit = 0.5;                    // m/s and rad/s, until the robot describes itself.
constexpr auto kPeriod = std::chrono::milliseconds(50);  // Period of the joystick samples.

constexpr const char* kInstructions =
    "arrows or w a s d: drive   q e: sideways   space: zero   + -: speed   x: software stop   Esc: quit\r\n"
    "game controller: left stick drives, right stick turns, A stops, B quits; k: dead man's switch (left "
    "shoulder)\r\n";

/// Describes the robot's motion in one line.
std::string status_line(const Robot& robot, const std::array<double, 3>& asked, double scale, bool dead_man,
                        const std::string& pad) {
  char text[256];
  std::snprintf(text, sizeof text,
                "\r\x1b[K%s  asked %5.2f %5.2f %5.2f  robot %5.2f %5.2f %5.2f  x%.1f  pad: %s%s",
                robot.mode.empty() ? "?" : robot.mode.c_str(), asked[0], asked[1], asked[2],
                static_cast<double>(robot.vx), static_cast<double>(robot.vy), static_cast<double>(robot.wz),
                scale, pad.c_str(), dead_man ? " (hold L)" : "");
  return text;
}

}  // namespace

int teleop(client::Connection& client, const Options& options, const std::string& robot) {
  std::optional<CommandOutcome> outcome;
  Robot view;
  std::int64_t id = 0;
  client.on_outcome = [&](std::int64_t ended, const CommandOutcome& result) {
    if (ended == id) outcome = result;
  };
  client.on_world = [&](const World& world) {
    if (const Robot* found = world.robot(robot)) view = *found;
  };
  Terminal terminal(false);
  if (!terminal.usable())
    return fail(options, kExitUsage,
                {Reason::bad_argument, "teleop wants a terminal; in a script use drive"});
  Gamepad pad;
  KeyStick keys;
  bool dead_man = false, stop_pressed = false, leaving = false;
  terminal.write(kInstructions);
  client.follow();
  id = client.teleop(robot);
  auto next = Clock::now();
  while (!outcome) {
    const auto now = Clock::now();
    keys.set_limits(view.max_speed, view.max_turn);
    bool stop = false;
    for (const int key : decode_keys(terminal.read())) {
      if (key == input::key_escape || key == input::key_interrupt) leaving = true;
      if (key == 'x') stop = true;
      if (key == 'k') dead_man = !dead_man;
      keys.press(key, now);
    }
    const Gamepad::State held = pad.read();
    stop = stop || (held.stop && !stop_pressed);
    stop_pressed = held.stop;
    if (stop) client.execute("stop " + robot);
    if (leaving || held.quit || interrupted()) {
      client.cancel(id);
      leaving = true;
    }
    std::array<double, 3> velocity = keys.velocity(now);
    if (held.present && (held.shoulder || !dead_man)) {
      const double speed = view.described ? view.max_speed : kUnknownLimit;
      const double turn = view.described ? view.max_turn : kUnknownLimit;
      velocity[0] += held.stick[0] * speed;
      velocity[1] += held.stick[1] * speed;
      velocity[2] += held.stick[2] * turn;
    }
    if (now >= next) {
      if (!leaving) client.stick(id, velocity[0], velocity[1], velocity[2]);
      terminal.write(status_line(view, velocity, keys.scale(), dead_man, pad.name()));
      next = now + kPeriod;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(next - Clock::now()).count();
    if (!client.wait(static_cast<int>(std::max<long>(left, 0)) + 1, STDIN_FILENO)) {
      terminal.write("\r\n");
      return fail(options, kExitNoAnswer, {Reason::no_answer, client.gone()});
    }
  }
  terminal.write("\r\x1b[K");
  const bool quit =
      leaving && !outcome->answers.empty() && outcome->answers.front().reason == Reason::cancelled;
  if (!quit) return print_outcome(options, *outcome);
  terminal.write(robot + ": manual control ended\r\n");
  return kExitDone;
}

}  // namespace adit::station::cli

// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/teleop.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "basestation/cli/interrupt.hpp"
#include "basestation/cli/terminal/gamepad.hpp"
#include "basestation/cli/terminal/key_stick.hpp"
#include "basestation/cli/terminal/keys.hpp"
#include "basestation/cli/terminal/terminal.hpp"

namespace adit::station::cli {
namespace {

using nlohmann::json;
using Clock = KeyStick::Clock;

constexpr auto kPeriod = std::chrono::milliseconds(50);  // Period of the joystick samples.

constexpr const char* kInstructions =
    "arrows or w a s d: drive   q e: sideways   space: zero   + -: speed   x: software stop   Esc: quit\r\n"
    "game controller: left stick drives, right stick turns, A stops, B quits; k: dead man's switch (left "
    "shoulder)\r\n";

/// Describes the robot's motion in one line.
std::string status_line(const json& robot, const std::array<double, 3>& asked, double scale, bool dead_man,
                        const std::string& pad) {
  const json speed = robot.value("velocity", json::array({0.0, 0.0, 0.0}));
  const auto number = [](const json& value) { return value.is_number() ? value.get<double>() : 0.0; };
  char text[256];
  std::snprintf(text, sizeof text,
                "\r\x1b[K%s  asked %5.2f %5.2f %5.2f  robot %5.2f %5.2f %5.2f  x%.1f  pad: %s%s",
                robot.value("mode", std::string("?")).c_str(), asked[0], asked[1], asked[2], number(speed[0]),
                number(speed[1]), number(speed[2]), scale, pad.c_str(), dead_man ? " (hold L)" : "");
  return text;
}

}  // namespace

int teleop(Client& client, const Options& options, const std::string& robot) {
  std::optional<json> outcome;
  json view = json::object();
  std::int64_t id = 0;
  client.on_outcome = [&](std::int64_t ended, const json& object) {
    if (ended == id) outcome = object;
  };
  client.on_snapshot = [&](const json& snapshot) {
    for (const json& row : snapshot.value("robots", json::array()))
      if (row.value("robot", std::string()) == robot) view = row;
  };
  Terminal terminal(false);
  if (!terminal.usable())
    return fail(options, kExitUsage,
                {Reason::bad_argument, "teleop wants a terminal; in a script use drive"});
  Gamepad pad;
  KeyStick keys;
  bool dead_man = false, stop_pressed = false, leaving = false;
  terminal.write(kInstructions);
  client.watch();
  id = client.teleop(robot);
  auto next = Clock::now();
  while (!outcome) {
    const auto now = Clock::now();
    keys.set_limits(view.value("max_speed", 0.0), view.value("max_turn", 0.0));
    bool stop = false;
    for (const int key : decode_keys(terminal.read())) {
      if (key == key_escape || key == key_interrupt) leaving = true;
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
      velocity[0] += held.stick[0] * view.value("max_speed", 0.5);
      velocity[1] += held.stick[1] * view.value("max_speed", 0.5);
      velocity[2] += held.stick[2] * view.value("max_turn", 0.5);
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
  const json result = outcome->value("json", json::object());
  const json rows = result.value("results", json::array());
  const bool quit = leaving && !rows.empty() && rows[0].value("reason", std::string()) == "cancelled";
  if (!quit) return print_outcome(options, *outcome);
  terminal.write(robot + ": manual control ended\r\n");
  return kExitDone;
}

}  // namespace adit::station::cli

// SPDX-License-Identifier: Apache-2.0
#include "bench/team/convoy_course.hpp"

#include <fmt/format.h>

#include <array>

namespace adit::bench {
namespace {

struct Body {
  const char* platform;
  double length, width;  ///< m
};
constexpr std::array<Body, 3> kBodies{
    {{"tracked", 0.80, 0.60}, {"wheeled", 0.60, 0.50}, {"legged", 0.90, 0.45}}};

const Body& body(int robot) { return kBodies[static_cast<std::size_t>(robot) % kBodies.size()]; }

}  // namespace

std::string ConvoyCourse::platform(int robot) const { return body(robot).platform; }
double ConvoyCourse::length(int robot) const { return body(robot).length; }
double ConvoyCourse::width(int robot) const { return body(robot).width; }

std::string ConvoyCourse::scenario_text() const {
  std::string text = fmt::format(
      "world: {{boxes: [[-20, 44, -2.3, -2, 0, 3], [-20, 40, 2, 2.3, 0, 3], [-20.3, -20, -2.3, 2.3, 0, 3],\n"
      "                [44, 44.3, -2.3, 50, 0, 3], [39.7, 40, 2.3, 50, 0, 3], [39.7, 44.3, 50, 50.3, 0, "
      "3]],\n"
      "        floor: 0, ceiling: 3}}\n"
      "duration: {}\nlink: {}\nlidar: {}\nodometry: {{noise: {}}}\nrobots:\n",
      kEnd / 1s, link, full ? "full" : "planar", noise);
  std::string names;
  double x = 0.0;
  for (int i = 0; i < robots; ++i) {
    if (i > 0) x -= (length(i - 1) + length(i)) / 2 + kGap;
    text += fmt::format("  - {{id: {}, platform: {}, pose: [{:.2f}, 0, 0]}}\n", name(i), platform(i), x);
    names += " " + name(i);
  }
  text += "basestations: [{id: op1, pose: [0, 1]}]\nscript:\n";
  const auto say = [&](double at, const std::string& line) {
    text += fmt::format("  - {{at: {}, by: op1, do: {}}}\n", at, line);
  };
  say(1, "take" + names);
  say(3, "convoy start" + names);
  say(6, fmt::format("drive r1 {} 0 0 --for {}", kSlow, seconds(kStep) - 5));
  say(seconds(kStep), fmt::format("drive r1 {} 0 0 --for {}", kFast, seconds(kLetGo - kStep)));
  say(seconds(kCorner), "goto r1 42 45");
  if (robots > 2) say(seconds(kPeelOff), "peeloff r2");
  return text;
}

}  // namespace adit::bench

// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/random_script.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/command/parse.hpp"

namespace adit::sim {
namespace {

RandomScript spec() {
  return {
      200,          5s,
      55s,          {"op1", "op2", "op3"},
      {"r1", "r2"}, {"take", "release", "lock", "unlock", "grant", "goto", "drive", "stop", "reset", "mode"},
      {3.0, 3.0}};
}

Scenario scenario() {
  Scenario s;
  s.robots = {{"r1", "wheeled", {1, 2, 0}}, {"r2", "legged", {5, 5, 0}}};
  return s;
}

TEST(RandomScript, SameSeedSameLines) {
  const auto a = draw_script(spec(), scenario(), Random(4)), b = draw_script(spec(), scenario(), Random(4));
  ASSERT_EQ(a.size(), 200U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].at, b[i].at);
    EXPECT_EQ(a[i].command, b[i].command);
  }
}

TEST(RandomScript, AnotherSeedOtherLines) {
  const auto a = draw_script(spec(), scenario(), Random(4)), b = draw_script(spec(), scenario(), Random(5));
  EXPECT_FALSE(std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](const auto& x, const auto& y) { return x.command == y.command; }));
}

TEST(RandomScript, EveryLineIsOneThatAnOperatorCanType) {
  for (const ScriptLine& line : draw_script(spec(), scenario(), Random(6))) {
    const auto request = command::parse(line.command);
    if (line.command.find("explore") != std::string::npos) continue;
    EXPECT_TRUE(request.ok()) << line.command << ": " << (request ? "" : request.error().text);
  }
}

TEST(RandomScript, ConvoysAreStartedStoppedAndLeft) {
  RandomScript convoys = spec();
  convoys.verbs = {"convoy", "peeloff"};
  convoys.robots = {"r1", "r2", "r3"};
  std::set<std::string> seen;
  for (const ScriptLine& line : draw_script(convoys, scenario(), Random(8))) {
    const auto request = command::parse(line.command);
    EXPECT_TRUE(request.ok()) << line.command << ": " << (request ? "" : request.error().text);
    for (const char* text :
         {"convoy start r2 r1 r3", "convoy start r1 r2", "convoy stop", "peeloff", "mode r3 convoy_follow"})
      if (line.command.starts_with(text)) seen.insert(text);
  }
  EXPECT_EQ(seen.size(), 5U);
}

TEST(RandomScript, AreasAreAddedAndRemovedWithinReachOfTheStart) {
  RandomScript areas = spec();
  areas.verbs = {"area"};
  areas.reach = {4.0, 0.5};
  std::set<std::string> seen;
  double farthest = 0.0;
  for (const ScriptLine& line : draw_script(areas, scenario(), Random(9))) {
    const auto request = command::parse(line.command);
    EXPECT_TRUE(request.ok()) << line.command << ": " << (request ? "" : request.error().text);
    for (const char* text : {"add near keep_out", "add far keep_in", "remove near"})
      if (line.command.find(text) != std::string::npos) seen.insert(text);
    double x0{}, y0{}, x1{}, y1{};
    const std::size_t corners = line.command.find("keep_");
    if (corners == std::string::npos) continue;
    ASSERT_EQ(std::sscanf(line.command.c_str() + corners, "%*s %lf %lf %lf %lf", &x0, &y0, &x1, &y1), 4);
    const bool first = line.command.starts_with("area r1");
    EXPECT_NEAR((x0 + x1) / 2, first ? 1 : 5, 4.01);
    EXPECT_NEAR((y0 + y1) / 2, first ? 2 : 5, 0.51);
    farthest = std::max(farthest, std::abs((x0 + x1) / 2 - (first ? 1 : 5)));
  }
  EXPECT_GT(farthest, 3.0);
  EXPECT_EQ(seen.size(), 3U);
}

TEST(RandomScript, KeepsToItsTimesAndUsesEveryVerb) {
  std::set<std::string> verbs;
  Duration last{};
  for (const ScriptLine& line : draw_script(spec(), scenario(), Random(7))) {
    EXPECT_GE(line.at, std::max(last, Duration(5s)));
    EXPECT_LE(line.at, Duration(55s));
    last = line.at;
    verbs.insert(line.command.substr(0, line.command.find(' ')));
  }
  EXPECT_EQ(verbs.size(), spec().verbs.size());
}

}  // namespace
}  // namespace adit::sim

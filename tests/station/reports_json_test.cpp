// SPDX-License-Identifier: Apache-2.0
// The reports of queries as JSON and back.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/json.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/stairs.hpp"
#include "core/time/random.hpp"

namespace adit::station {
namespace {

using nlohmann::json;

class ReportDraw {
 public:
  explicit ReportDraw(std::uint64_t seed) : random_(seed) {}
  std::size_t below(std::size_t n) {
    return std::min(static_cast<std::size_t>(random_.uniform() * static_cast<double>(n)), n - 1);
  }
  bool flag() { return below(2) == 1; }
  std::string text() {
    static const std::vector<std::string> kTexts{
        "", "r1", "\"quoted\"", "line\nbreak", "\x01\x1b[31m", "<b>bold</b>", "äöü ▲", std::string(240, 'x')};
    return kTexts[below(kTexts.size())];
  }
  double number() {
    static const std::vector<double> kNumbers{0.0, -0.0, 1.5, -1e300, 0.1, 1e-9};
    return kNumbers[below(kNumbers.size())];
  }
  float single() { return static_cast<float>(below(1000)) * 0.37F; }
  std::uint32_t count() { return flag() ? std::numeric_limits<std::uint32_t>::max() : 3; }
  std::optional<double> maybe() { return flag() ? std::optional(number()) : std::nullopt; }

  HealthReport health() {
    HealthReport report;
    report.robots.resize(below(4));
    for (RobotHealth& robot : report.robots) {
      robot.robot = text();
      robot.components.resize(below(4));
      for (ComponentHealth& part : robot.components)
        part = {text(), static_cast<PartState>(below(5)), flag(), flag(), single(), count(), count(), text()};
    }
    return report;
  }
  SenderReport sender() {
    SenderReport out{text(), number(), number(), number(), {}};
    if (flag()) out.dropped[text()] = count();
    return out;
  }
  NetworkReport network() {
    NetworkReport report;
    report.agents.resize(below(3));
    for (AgentTraffic& agent : report.agents) {
      agent = {text(), number(), single(), single(), single(), single(), count(), {}, {}, {}};
      if (flag()) agent.classes_out[text()] = number();
      if (flag()) agent.hears[text()] = number();
      agent.topics.resize(below(3));
      for (TopicTraffic& topic : agent.topics)
        topic = {text(), single(), single(), single(), single(), count()};
    }
    report.links.resize(below(3));
    for (LinkReport& link : report.links) {
      link = {text(), number(), number(), maybe(), maybe(), maybe(), maybe(), maybe(), {}};
      if (flag()) link.sender = sender();
    }
    if (flag()) report.sender = sender();
    return report;
  }
  FoundReport found() {
    FoundReport report;
    report.findings.resize(below(4));
    for (FoundItem& item : report.findings)
      item = {count(),
              text(),
              text(),
              text(),
              static_cast<std::uint8_t>(below(256)),
              {number(), number(), number()},
              text(),
              maybe(),
              static_cast<Verdict>(below(3)),
              text(),
              flag(),
              photo(),
              std::vector<std::uint32_t>(below(3), count()),
              flag()};
    report.at_robots.resize(below(3));
    for (FoundAtRobot& robot : report.at_robots) robot = {text(), count(), count(), count()};
    return report;
  }
  StairsReport stairs() {
    StairsReport report;
    report.unreadable = count();
    report.stairs.resize(below(4));
    for (StairsItem& item : report.stairs) {
      item.number = count();
      item.stairs = {.foot = {number(), number(), number()},
                     .heading = random_.uniform(-3.0, 3.0),
                     .rise = random_.uniform(0.1, 0.25),
                     .run = random_.uniform(0.2, 0.45),
                     .width = random_.uniform(0.6, 10.0),
                     .steps = 3 + static_cast<int>(below(97)),
                     .sigma = {.place = random_.uniform(), .heading = random_.uniform(), .width = 0.1}};
      item.findings.resize(below(3), count());
      item.robots.resize(below(3), text());
      item.verdict = static_cast<Verdict>(below(3));
      item.note = text();
      item.fleet.resize(below(3));
      for (Climber& robot : item.fleet) robot = {text(), flag(), text()};
    }
    return report;
  }

 private:
  std::optional<FoundPhoto> photo() {
    if (flag()) return std::nullopt;
    return FoundPhoto{static_cast<PhotoHere>(below(3)), static_cast<std::uint8_t>(below(101)), count(),
                      text()};
  }

  Random random_;
};

template <class Report>
CommandOutcome outcome_with(const Report& report) {
  return {.json = line_of(json_of(report))};
}

TEST(ReportsJson, ComeBackAsTheyWere) {
  ReportDraw draw(1);
  for (int i = 0; i < 500; ++i) {
    const HealthReport health = draw.health();
    ASSERT_EQ(health_of(outcome_with(health)).value(), health);
    const NetworkReport network = draw.network();
    ASSERT_EQ(network_of(outcome_with(network)).value(), network);
    const FoundReport found = draw.found();
    ASSERT_EQ(findings_of(outcome_with(found)).value(), found);
    const StairsReport stairs = draw.stairs();
    ASSERT_EQ(stairs_of(outcome_with(stairs)).value(), stairs);
  }
}

/// Changes one value somewhere to something else.
void spoil_report(json& value, ReportDraw& draw) {
  if (value.is_structured() && !value.empty() && draw.below(8) != 0) {
    auto at = value.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(draw.below(value.size())));
    return spoil_report(*at, draw);
  }
  static const std::vector<json> kOdd{nullptr,       true,           -1,        1e300, "x",
                                      json::array(), json::object(), 1ULL << 63};
  value = kOdd[draw.below(kOdd.size())];
}

TEST(ReportsJson, WhatDoesNotFitIsRefusedOrHarmless) {
  ReportDraw draw(2);
  int refused = 0;
  const auto check = [&](json object, const auto& read) {
    for (std::size_t k = 0; k <= draw.below(3); ++k) spoil_report(object, draw);
    const auto report = read(CommandOutcome{.json = line_of(object)});
    if (report) return void(line_of(json_of(*report)));
    ++refused;
    EXPECT_EQ(report.error().reason, Reason::malformed);
    EXPECT_THAT(report.error().text, testing::HasSubstr("does not fit"));
  };
  for (int i = 0; i < 300; ++i) {
    check(json_of(draw.health()), health_of);
    check(json_of(draw.network()), network_of);
    check(json_of(draw.found()), findings_of);
    check(json_of(draw.stairs()), stairs_of);
  }
  EXPECT_GT(refused, 300);
}

TEST(ReportsJson, AnOutcomeThatIsNoReportIsAnError) {
  for (const char* text : {"", "x", "[]", "5", R"({"robots": 5})"})
    EXPECT_FALSE(health_of({.json = text})) << text;
  const auto none = network_of({.exit_code = kExitNoAnswer, .error = "no station is running\n"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().reason, Reason::no_answer);
  EXPECT_FALSE(findings_of({.json = R"({"findings": [{"verdict": "perhaps"}]})"}));
  EXPECT_FALSE(stairs_of({.json = R"({"stairs": [{"number": 1, "steps": 6}]})"})) << "no height of a step";
  EXPECT_FALSE(health_of({.json = R"({"robots": [{"components": [{"policy": "never"}]}]})"}));
  EXPECT_FALSE(health_of({.json = R"({"robots": [{"components": [{"state": "dancing"}]}]})"}));
}

}  // namespace
}  // namespace adit::station

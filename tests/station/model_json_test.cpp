// SPDX-License-Identifier: Apache-2.0
// The model as JSON and back: nothing is lost, and nothing that does not fit gets in.
#include "basestation/model/json.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/time/random.hpp"

namespace adit::station {
namespace {

using nlohmann::json;

/// Draws values of the model as a station can report them, the extremes among them.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) {
    return std::min(static_cast<std::size_t>(random_.uniform() * static_cast<double>(n)), n - 1);
  }
  bool flag() { return below(2) == 1; }
  std::string text() {
    static const std::vector<std::string> kTexts{"",
                                                 "r1",
                                                 "a b",
                                                 "\"quoted\"",
                                                 "back\\slash",
                                                 "line\nbreak",
                                                 "tab\t",
                                                 "\x01\x1b[31m",
                                                 "<b>bold</b>",
                                                 "äöü ▲ 日本",
                                                 "{\"json\":1}",
                                                 "null",
                                                 std::string(240, 'x'),
                                                 std::string("a\0b", 3)};
    return kTexts[below(kTexts.size())];
  }
  std::vector<std::string> texts() {
    std::vector<std::string> out(below(4));
    for (std::string& one : out) one = text();
    return out;
  }
  double number() {
    static const std::vector<double> kNumbers{
        0.0, -0.0, 1.0, 1e-300, 1e30, -1e30, 0.1, 1.0 / 3.0, std::numeric_limits<double>::quiet_NaN()};
    return below(2) == 0 ? kNumbers[below(kNumbers.size())] : random_.uniform() * 1000.0 - 500.0;
  }
  float single() { return static_cast<float>(number()); }
  /// An amount of which 0 means unknown.
  float amount() { return flag() ? 0.0F : static_cast<float>(0.01 + random_.uniform()); }
  std::uint64_t integer() {
    return flag() ? std::numeric_limits<std::uint64_t>::max() - below(3) : below(1000);
  }
  template <class Enum>
  Enum one_of(Enum last) {
    return static_cast<Enum>(below(static_cast<std::size_t>(last) + 1));
  }
  Reason reason() {
    for (;;) {  // Only some numbers have a reason.
      const auto drawn = static_cast<Reason>(below(1000));
      if (name(drawn) != "unknown") return drawn;
    }
  }

  Robot robot() {
    Robot r;
    r.name = text();
    r.age = number();
    r.lost = flag();
    if (flag()) describe(r);
    r.platform = text();
    r.software = text();
    r.protocol = static_cast<std::uint16_t>(below(65536));
    r.max_speed = single();
    r.max_turn = single();
    r.sensors = texts();
    r.services = texts();
    if (flag()) place(r);
    r.epoch = {integer(), static_cast<std::uint32_t>(below(1U << 31))};
    r.holder = text();
    r.mine = flag();
    r.locked = flag();
    r.lease_left = single();
    r.stops = texts();
    r.stopped_by_holder = flag();
    r.mode = text();
    r.stopped = flag();
    r.moving_allowed = flag();
    r.reason = reason();
    r.goal_state = one_of(GoalState::reached);
    r.goal_id = static_cast<std::uint32_t>(below(1U << 31));
    if (r.goal_state != GoalState::none) r.goal = {number(), number(), number()};
    r.exploration.phase = one_of(ExplorationPhase::ended);
    if (r.exploration.phase != ExplorationPhase::none)
      r.exploration = {r.exploration.phase, reason(), single(), single(), 7, 9};
    r.options.resize(below(3));
    for (ModeOption& option : r.options) option = {text(), flag(), reason()};
    r.yields = flag();
    r.yields_to = text();
    r.convoy = texts();
    r.areas.resize(below(3));
    for (Area& area : r.areas) area = this->area();
    r.troubles = texts();
    return r;
  }
  World world() {
    World w{.station = text(),
            .link = text(),
            .commands = {integer(), integer(), integer(), integer(), integer()},
            .findings = {static_cast<std::uint32_t>(below(1U << 31)),
                         static_cast<std::uint32_t>(below(1U << 31)), integer()}};
    w.robots.resize(below(3));
    for (Robot& one : w.robots) one = robot();
    w.stations.resize(below(3));
    for (StationSummary& station : w.stations) {
      station = {text(), flag(), number(), flag(), {}};
      if (flag()) station.place = {single(), single(), single()};
    }
    w.notices.resize(below(4));
    for (Notice& notice : w.notices)
      notice = {
          {text(), one_of(Severity::error), text(), reason(), text(), text()}, integer(), number(), flag()};
    if (flag()) w.traffic[text()] = {number(), number(), number()};
    return w;
  }
  CommandEvent event() {
    CommandEvent e{
        .id = integer(), .ended = flag(), .line = text(), .query = flag(), .front_end = text(), .pid = 4711};
    if (!e.ended) return e;
    e.exit_code = static_cast<int>(below(4));
    e.text = text();
    e.error = text();
    return e;
  }

 private:
  void describe(Robot& r) {
    r.described = true;
    r.max_acceleration = amount();
    r.holonomic = flag();
    r.size = {amount(), amount(), amount()};
    r.max_step = amount();
    r.max_slope = amount();
    r.climbs_stairs = flag();
  }
  void place(Robot& r) {
    r.located = true;
    r.x = single(), r.y = single(), r.z = single(), r.yaw = single();
    r.vx = single(), r.vy = single(), r.wz = single();
    r.roll = single(), r.pitch = single();
    r.map_revision = static_cast<std::uint8_t>(below(256));
    if (flag()) route(r.route);
    if (flag()) r.battery = static_cast<float>(random_.uniform());
    r.localisation = one_of(Localisation::lost);
    if (r.localisation != Localisation::off) r.sigma = number();
  }
  void route(contract::Route& r) {
    r = {.goal_id = static_cast<std::uint32_t>(integer()), .corners = 40, .points = {}, .unknown = 5};
    r.points.resize(1 + below(contract::Route::kMaxCorners));
    for (auto& point : r.points) point = {single(), single(), single()};
  }
  Area area() {
    Area a{.name = text(), .kind = one_of(AreaKind::prefer)};
    a.corners.resize(below(5));
    for (auto& corner : a.corners) corner = {single(), single()};
    if (flag()) a.z_min = -1.5F;
    if (flag()) a.z_max = 2.25F;
    if (a.kind == AreaKind::prefer) a.weight = single();
    return a;
  }
  Random random_;
};

/// What a reader makes of a value that was written, sent as text and read.
template <class Read>
auto sent(const json& value, const Read& read) {
  return read(json::parse(line_of(value)));
}

TEST(ModelJson, ARobotComesBackAsItWas) {
  Draw draw(1);
  for (int i = 0; i < 1000; ++i) {
    const Robot robot = draw.robot();
    const auto back = sent(json_of(robot), robot_from);
    ASSERT_TRUE(back) << back.error().text;
    // NaN is not equal to itself, but its text is.
    ASSERT_EQ(line_of(json_of(*back)), line_of(json_of(robot)));
    ASSERT_EQ(back->areas.size(), robot.areas.size());
    ASSERT_EQ(back->located, robot.located);
    ASSERT_EQ(back->size, robot.size);
    ASSERT_EQ(back->battery, robot.battery);
    ASSERT_EQ(std::isnan(back->x), std::isnan(robot.x));
    ASSERT_EQ(std::signbit(back->goal[0]), std::signbit(robot.goal[0])) << "also of -0";
    for (std::size_t k = 0; k < robot.areas.size(); ++k) {
      ASSERT_EQ(back->areas[k].z_min, robot.areas[k].z_min);
      ASSERT_EQ(back->areas[k].z_max, robot.areas[k].z_max);
    }
  }
}

TEST(ModelJson, AWorldComesBackAsItWas) {
  Draw draw(2);
  for (int i = 0; i < 300; ++i) {
    const World world = draw.world();
    const auto back = sent(json_of(world), world_from);
    ASSERT_TRUE(back) << back.error().text;
    ASSERT_EQ(line_of(json_of(*back)), line_of(json_of(world)));
    ASSERT_EQ(back->commands, world.commands);
    ASSERT_EQ(back->findings, world.findings);
    ASSERT_EQ(back->robots.size(), world.robots.size());
    ASSERT_EQ(back->traffic.size(), world.traffic.size());
  }
}

TEST(ModelJson, ACommandEventComesBackAsItWas) {
  Draw draw(3);
  for (int i = 0; i < 1000; ++i) {
    const CommandEvent event = draw.event();
    const auto back = sent(json_of(event), event_from);
    ASSERT_TRUE(back) << back.error().text;
    ASSERT_EQ(*back, event);
  }
}

TEST(ModelJson, EveryReasonComesBackAndThatOfANewerVersionIsNotNone) {
  for (int number = 0; number < 2000; ++number) {
    const auto reason = static_cast<Reason>(number);
    if (name(reason) == "unknown") continue;
    EXPECT_EQ(sent(json_of(Notice{{.reason = reason}}), notice_from)->reason, reason);
  }
  const auto later = notice_from({{"reason", "of_a_later_version"}});
  ASSERT_TRUE(later);
  EXPECT_NE(later->reason, Reason::none);
}

TEST(ModelJson, BytesThatAreNoTextAreReplaced) {
  const auto back = sent(json_of(Notice{{.text = "a\xff\xfe b"}}), notice_from);
  ASSERT_TRUE(back);
  EXPECT_THAT(back->text, testing::StartsWith("a"));
}

TEST(ModelJson, AnOutcomeHasTheAnswersOfItsRobots) {
  const json script{
      {"results",
       {{{"robot", "r1"}, {"accepted", true}, {"answered", true}, {"reason", "none"}, {"text", ""}},
        {{"robot", "r2"}, {"accepted", false}, {"reason", "locked"}, {"holder", "op2"}},
        {{"row", "of another kind"}},
        5}}};
  const auto outcome = sent(outcome_json(1, "text\n", "error\n", script), outcome_from);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->exit_code, 1);
  EXPECT_EQ(outcome->error, "error\n");
  EXPECT_EQ(json::parse(outcome->json), script);
  ASSERT_EQ(outcome->answers.size(), 2U);
  EXPECT_TRUE(outcome->answers[0].accepted);
  EXPECT_EQ(outcome->answers[1].reason, Reason::locked);
  EXPECT_EQ(outcome->answers[1].holder, "op2");
}

MapTile tile(int x, int y, std::uint64_t seed) {
  MapTile out{.x = x, .y = y, .revision = seed};
  Random random(seed);
  while (out.cells.size() < std::size_t{MapTile::kSide} * MapTile::kSide) {
    const auto run = static_cast<std::size_t>(random.uniform() * 40.0) + 1;
    const auto value = static_cast<std::uint8_t>(random.uniform() * 256.0);
    for (std::size_t i = 0; i < run && out.cells.size() < std::size_t{MapTile::kSide} * MapTile::kSide; ++i)
      out.cells.push_back(value);
  }
  for (int cell = 0; cell < MapTile::kSide * MapTile::kSide;
       cell += 1 + static_cast<int>(random.uniform() * 90.0))
    for (int z = static_cast<int>(random.uniform() * 60000.0) - 32000, k = 0; k < 3; ++k, z += 400)
      out.runs.push_back({static_cast<std::uint16_t>(cell), static_cast<std::int16_t>(z),
                          static_cast<std::uint16_t>(1 + random.uniform() * 300.0)});
  for (int region = 0; region < MapTile::kRegions * MapTile::kRegions; ++region)
    out.received.push_back(static_cast<std::uint32_t>(random.uniform() * 3.0) * 100'000);
  return out;
}

TEST(ModelJson, TilesOfTheMapComeBackAsTheyWere) {
  const MapUpdate update{.resolution = 0.2,
                         .revision = 9,
                         .clock = 500'000,
                         .run = 1ULL << 63,
                         .tiles = {tile(-3, 2, 5), tile(0, 0, 9)}};
  const auto back = sent(json_of(update), map_update_from);
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_EQ(back->run, update.run);
  EXPECT_EQ(back->clock, update.clock);
  ASSERT_EQ(back->tiles.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back->tiles[i].x, update.tiles[i].x);
    EXPECT_EQ(back->tiles[i].revision, update.tiles[i].revision);
    EXPECT_EQ(back->tiles[i].cells, update.tiles[i].cells);
    EXPECT_EQ(back->tiles[i].runs, update.tiles[i].runs);
    EXPECT_EQ(back->tiles[i].received, update.tiles[i].received);
    EXPECT_FALSE(update.tiles[i].runs.empty());
  }
}

/// Changes one value somewhere in a JSON value to something else.
void spoil(json& value, Draw& draw) {
  if ((value.is_object() || value.is_array()) && !value.empty() && draw.below(8) != 0) {
    auto at = value.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(draw.below(value.size())));
    return spoil(*at, draw);
  }
  static const std::vector<json> kOdd{nullptr,
                                      true,
                                      -1,
                                      1e300,
                                      "x",
                                      json::array(),
                                      json::object(),
                                      json::array({1, "x"}),
                                      1ULL << 63,
                                      -9.5,
                                      std::string(1000, 'y')};
  value = kOdd[draw.below(kOdd.size())];
}

TEST(ModelJson, WhatDoesNotFitIsRefusedOrHarmless) {
  Draw draw(4);
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    json object = json_of(draw.world());
    for (std::size_t k = 0; k <= draw.below(3); ++k) spoil(object, draw);
    const auto world = world_from(object);
    if (!world) {
      ++refused;
      EXPECT_EQ(world.error().reason, Reason::malformed);
      EXPECT_THAT(world.error().text, testing::HasSubstr("does not fit"));
      continue;
    }
    (void)line_of(json_of(*world));
  }
  EXPECT_GT(refused, 200);
  for (const json& odd : {json(5), json("x"), json(nullptr), json::array()}) {
    EXPECT_FALSE(world_from(odd));
    EXPECT_FALSE(robot_from(odd));
    EXPECT_FALSE(outcome_from(odd));
    EXPECT_FALSE(map_update_from(odd));
  }
}

TEST(ModelJson, HostileTilesAreRefused) {
  const json good = json_of(MapUpdate{.revision = 1, .tiles = {tile(0, 0, 1)}});
  ASSERT_TRUE(map_update_from(good));
  const auto with = [&](const char* key, const json& value) {
    json object = good;
    object["tiles"][0][key] = value;
    return map_update_from(object).ok();
  };
  EXPECT_FALSE(with("cells", json::array({1, 16383}))) << "one cell is missing";
  EXPECT_FALSE(with("cells", json::array({1, 16385}))) << "one too many";
  EXPECT_FALSE(with("cells", json::array({1, 4'000'000'000U})));
  EXPECT_FALSE(with("cells", json::array({256, 16384}))) << "no such cell";
  EXPECT_FALSE(with("cells", json::array({1}))) << "half a run";
  EXPECT_FALSE(with("cells", json::array()));
  EXPECT_FALSE(with("columns", json::array({0, 1}))) << "a run has three numbers";
  EXPECT_FALSE(with("columns", json::array({16384, 1, 1}))) << "no such cell";
  EXPECT_FALSE(with("columns", json::array({16383, 1, 1, 1, 1, 1}))) << "beyond the last cell";
  EXPECT_FALSE(with("columns", json::array({0, 65536, 1})));
  EXPECT_FALSE(with("columns", json::array({0, 1, 0}))) << "nothing is no run";
  EXPECT_FALSE(with("columns", json(std::vector<std::uint32_t>(3 * (MapTile::kMaxRuns + 1), 1))));
  EXPECT_TRUE(with("columns", json::array())) << "a flat station";
  EXPECT_FALSE(with("x", 5'000'000'000));
  EXPECT_FALSE(with("received", json::array({1, 255}))) << "one region is missing";
  EXPECT_FALSE(with("received", json::array({1, 257}))) << "one too many";
  EXPECT_FALSE(with("received", json::array({1}))) << "half a run";
  EXPECT_TRUE(with("received", json::array())) << "a station of an earlier release";
}

}  // namespace
}  // namespace adit::station

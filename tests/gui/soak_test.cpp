// SPDX-License-Identifier: Apache-2.0
// Half an hour of a mission in the window, in a few minutes: everything changes, tabs, views and themes are
// switched, and the memory does not grow with time.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {
namespace {

constexpr double kStep = 0.5;           // Of the mission, s.
constexpr double kGrowthPerHour = 5.0;  // MB
constexpr double kNoise = 2.0;          // Of the allocator between two looks, MB.

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0, resident = 0.0;
  statm >> pages >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

class Soak : public TabsTest {
 protected:
  ~Soak() override {
    Theme::instance().set_light(false);
    Theme::instance().set_glove(false);
  }
  /// The world at that time, s: robots move, get lost and come back, are blocked, stopped and taken.
  void pass(int step) {
    const double t = kStep * step;
    station::World world = ten_robots();
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
      station::Robot& robot = world.robots[i];
      const double phase = 0.05 * t + static_cast<double>(i);
      robot.x += static_cast<float>(4.0 * std::sin(phase));
      robot.y += static_cast<float>(2.0 * std::cos(phase));
      robot.yaw = static_cast<float>(phase);
      robot.age = 0.1;
      robot.lost = std::fmod(t + 37.0 * static_cast<double>(i), 300.0) < 12.0;
      robot.battery = static_cast<float>(1.0 - std::fmod(t, 1800.0) / 2400.0);
      if (std::fmod(t + 53.0 * static_cast<double>(i), 200.0) < 20.0) robot.stops = {"op2"};
    }
    if (step % 400 > 350) world.robots.pop_back();
    show(world);
    const std::string name = "r" + std::to_string(step % 9 + 1);
    const char* codes[] = {"blocked",          "lost", "back", "arrived", "found",
                           "component_failed", "idle", "asked"};
    if (step % 6 == 0)
      control.add_notice(my_notice(static_cast<std::uint64_t>(step) + 1, name, codes[step / 6 % 8],
                                   "notification " + std::to_string(step)));
    if (step % 10 == 0)
      control.add_command({.ended = true, .line = "goto " + name + " " + std::to_string(step)});
    if (step % 40 == 0) {
      station::TileMap map = corridors();
      map.revision = static_cast<std::uint64_t>(step) + 2;
      control.show_map(std::make_shared<station::TileMap>(std::move(map)));
    }
  }
  void operate(int step) {
    const char* tabs[] = {"health", "network", "findings", "stairs", "cameras", "settings", "log"};
    if (step % 20 == 0) control.tabs()->toggle(tabs[step / 20 % static_cast<int>(std::size(tabs))]);
    if (step % 33 == 0) control.set_solid(!control.solid());
    if (step % 60 == 0) Theme::instance().set_light(!Theme::instance().light());
    if (step % 240 == 0) Theme::instance().set_glove(!Theme::instance().glove());
    if (step % 7 == 0) control.select("r" + QString::number(step / 7 % 9 + 1), step % 21 == 0);
    if (step % 50 == 0) control.details()->set_open(!control.details()->is_open());
    if (step % 45 == 0) control.set_reasons_open(!control.reasons_open());
    if (step % 55 == 0) control.attention()->set_open(!control.attention()->is_open());
    if (step % 9 == 0) control.order("mode r1 hold", "mode_hold");
    for (const auto& done : std::exchange(sink.pending, {})) done({.text = "r1: in hold\n"});
    for (const auto& [line, done] : std::exchange(sink.asked, {}))
      done(line == "health" ? answer_of(health_of_ten())
           : line == "net"  ? answer_of(network_of_ten())
                            : answer_of(some_findings()));
    sink.lines.clear();
    sink.queries.clear();
  }
};

TEST_F(Soak, HalfAnHourOfAMissionDoesNotGrow) {
  const char* text = std::getenv("ADIT_SOAK_MINUTES");
  const double minutes = text ? std::atof(text) : 30.0;
  const int steps = static_cast<int>(60.0 * minutes / kStep);
  // Logs and caches fill in the first third: they are bounded.
  const int begins = steps / 3;
  double before = 0.0;
  for (int step = 0; step < steps; ++step) {
    pass(step);
    operate(step);
    QCoreApplication::processEvents();
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);  // As an event loop would.
    if (step % 4 == 0) (void)window()->grabWindow();                      // Paints it, as a screen would.
    if (step == begins) before = resident_mb();
    if (step % (steps / 10 + 1) == 0)
      std::printf("minute %.1f: %.1f MB\n", kStep * step / 60.0, resident_mb());
    std::fflush(stdout);
  }
  const double grown = resident_mb() - before, hours = (minutes - minutes / 3.0) / 60.0;
  std::printf("after the first third: %.1f MB, grown by %.1f MB in %.2f h\n", before, grown, hours);
  EXPECT_LT(grown, kGrowthPerHour * hours + kNoise);
  EXPECT_LE(static_cast<RowModel*>(control.log())->rows().size(), Control::kMaxLog);
}

}  // namespace
}  // namespace adit::gui

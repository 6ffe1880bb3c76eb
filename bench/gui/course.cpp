// SPDX-License-Identifier: Apache-2.0
#include "bench/gui/course.hpp"

#include <QQuickItem>
#include <QQuickWindow>
#include <QTest>
#include <QTimer>
#include <atomic>
#include <cmath>
#include <thread>

#include "basestation/client/connection.hpp"
#include "basestation/client/line_socket.hpp"
#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/bridge/qt_station.hpp"
#include "basestation/gui/scene/map_view.hpp"
#include "basestation/gui/scene/map_view_3d.hpp"
#include "basestation/gui/window.hpp"
#include "tests/client/server_bench.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui::bench {
namespace {

constexpr int kRepeats = 100;
constexpr int kLimitMs = 5000;

struct NoSink : CommandSink {
  void look_at(const std::optional<station::LookedAt>&) override {}
  void execute(const std::string&, Done) override {}
  void query(const std::string&, Done) override {}
  void camera(const station::CameraRequest&, Done) override {}
  void photo(const std::string&, findings::PhotoPart, Done) override {}
  void stop(const std::vector<std::string>&, Done) override {}
  void start_station() override {}
};

QQuickItem* below(QQuickItem* top, const QString& name) {
  for (QQuickItem* child : top->childItems()) {
    if (child->objectName() == name) return child;
    if (QQuickItem* found = below(child, name)) return found;
  }
  return nullptr;
}

/// Ten robots under way, at the k-th state of their drive.
std::shared_ptr<const station::World> world_at(int k) {
  auto world = std::make_shared<station::World>(ten_robots());
  for (station::Robot& robot : world->robots) {
    robot.x += 0.08F * static_cast<float>(std::sin(0.05 * k));
    robot.yaw += 0.02F * static_cast<float>(k);
  }
  return world;
}

/// A map with that many tiles along each side, all of it known: 16384 cells a tile.
station::TileMap full_map(int tiles) {
  station::TileMap map;
  map.revision = 1;
  for (int x = 0; x < tiles; ++x)
    for (int y = 0; y < tiles; ++y) {
      auto tile = std::make_shared<station::MapTile>();
      tile->x = x - tiles / 2;
      tile->y = y - tiles / 2;
      tile->revision = 1;
      tile->cells.resize(static_cast<std::size_t>(station::MapTile::kSide) * station::MapTile::kSide);
      for (std::size_t i = 0; i < tile->cells.size(); ++i)
        tile->cells[i] = static_cast<std::uint8_t>(1 + (i * 7919 + i / 128) % 16);
      // A floor, and walls of 2.4 m in a grid of rooms: about one voxel a cell.
      for (std::size_t i = 0; i < tile->cells.size(); ++i) {
        const bool wall = i % 128 % 40 == 0 || i / 128 % 40 == 0;
        tile->runs.push_back({static_cast<std::uint16_t>(i), -1, static_cast<std::uint16_t>(wall ? 13 : 1)});
      }
      map.tiles[{tile->x, tile->y}] = tile;
    }
  return map;
}

/// Counts frames, and waits for the next one.
class Frames {
 public:
  explicit Frames(QQuickWindow& window) {
    QObject::connect(&window, &QQuickWindow::frameSwapped, &window, [this] { ++count_; });
  }
  int count() const { return count_; }
  bool next() {
    const int before = count_;
    return QTest::qWaitFor([&] { return count_ > before; }, kLimitMs);
  }

 private:
  int count_{0};
};

/// Share of a core while `ms` pass, %.
double processor_share(int ms) {
  const double used = processor_ms(), begun = steady_ms();
  QTest::qWait(ms);
  return 100.0 * (processor_ms() - used) / (steady_ms() - begun);
}

}  // namespace

Results window_results(double started) {
  Results results;
  NoSink sink;
  Control control(sink);
  int k = 0;
  double now = 100.0;
  const auto show = [&] { control.show(world_at(++k), now += 0.1); };
  show();
  const OperatorWindow window(control);
  Frames frames(*window.window());
  window.window()->resize(1280, 720);
  window.window()->show();
  frames.next();
  results.emplace_back("start to the first card, ms", steady_ms() - started);
  results.emplace_back("memory, ten robots, MB", resident_mb());

  std::vector<double> waits;
  for (int i = 0; i < kRepeats; ++i) {
    QTest::qWait(3);
    const double begun = steady_ms();
    show();
    if (frames.next()) waits.push_back(steady_ms() - begun);
  }
  results.emplace_back("state to pixel, median, ms", share_below(waits, 0.5));
  results.emplace_back("state to pixel, 99 %, ms", share_below(waits, 0.99));

  results.emplace_back("processor, nothing changes, %", processor_share(4000));
  QTimer states;
  QObject::connect(&states, &QTimer::timeout, show);
  states.start(100);
  results.emplace_back("processor, ten robots at 10 Hz, %", processor_share(6000));
  window.window()->hide();
  results.emplace_back("the same, window hidden, %", processor_share(4000));
  window.window()->show();
  states.stop();
  QTest::qWait(100);

  // 64 tiles of 16384 cells, all of them in view.
  const double before = resident_mb(), came = steady_ms();
  control.show_map(std::make_shared<station::TileMap>(full_map(8)));
  frames.next();
  results.emplace_back("frame in which a map of 1 M cells comes, ms", steady_ms() - came);
  QTest::qWait(500);
  results.emplace_back("memory for that map, MB", resident_mb() - before);
  auto* map = static_cast<MapView*>(below(window.window()->contentItem(), "map"));
  const double begun = steady_ms();
  const int first = frames.count();
  while (steady_ms() - begun < 4000.0) {
    map->zoomBy(frames.count() % 40 < 20 ? 1.02 : 1 / 1.02);
    if (!frames.next()) break;
  }
  results.emplace_back("frames per second, the map moves",
                       1e3 * (frames.count() - first) / (steady_ms() - begun));
  control.set_solid(true);
  auto* solid = static_cast<MapView3D*>(below(window.window()->contentItem(), "solid"));
  frames.next();
  QTest::qWait(400);
  results.emplace_back("voxels of the map, M", 1e-6 * static_cast<double>(solid->voxels().scene().voxels()));
  const double turned = steady_ms();
  const int before_turn = frames.count();
  while (steady_ms() - turned < 4000.0) {
    solid->zoomBy(frames.count() % 40 < 20 ? 1.03 : 1 / 1.03);
    if (!frames.next()) break;
  }
  results.emplace_back("frames per second, the map in 3D moves",
                       1e3 * (frames.count() - before_turn) / (steady_ms() - turned));
  return results;
}

namespace {

struct Bench : station::host::ServerBench {
  using ServerBench::path;
  using ServerBench::server_;
  void TestBody() override {}
};

/// Another front end, in a thread of its own: when the station began a command.
class Witness {
 public:
  explicit Witness(const std::string& path)
      : connection_(station::client::LineSocket::connect(path).value(), "witness") {
    connection_.on_command = [this](const station::CommandEvent& event) {
      if (!event.ended) begun_ = steady_ms();
    };
    connection_.notices();
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested() && connection_.wait(50)) {
      }
    });
  }
  void forget() { begun_ = 0.0; }
  double begun() const { return begun_; }

 private:
  std::atomic<double> begun_{0.0};
  station::client::Connection connection_;
  std::jthread thread_{};
};

}  // namespace

Results socket_results() {
  Results results;
  Bench bench;
  station::client::StationOptions options{.name = "op1", .program = "/bin/false"};
  auto opened = station::client::Station::open(options, "adit_gui");
  if (!opened) return {{"the station's socket could not be opened", 1.0}};
  QtStation qt_station(std::move(*opened));
  Control control(qt_station);
  qt_station.show_in(control);
  const OperatorWindow window(control);
  Frames frames(*window.window());
  window.window()->resize(1280, 720);
  window.window()->show();
  frames.next();
  QTest::qWait(500);

  std::vector<double> waits;
  for (int i = 0; i < kRepeats; ++i) {
    QTest::qWait(120);
    const int rows = control.log()->rowCount();
    const double begun = steady_ms();
    station::Notice notice;
    notice.code = "found";
    notice.text = "event";
    notice.id = 1000U + static_cast<unsigned>(i);
    notice.mine = true;
    bench.server_->notify(notice);
    if (QTest::qWaitFor([&] { return control.log()->rowCount() > rows; }, kLimitMs) && frames.next())
      waits.push_back(steady_ms() - begun);
  }
  results.emplace_back("event at the station to pixel, median, ms", share_below(waits, 0.5));
  results.emplace_back("event at the station to pixel, 99 %, ms", share_below(waits, 0.99));

  Witness witness(bench.path());
  QTest::qWait(200);
  QPointingDevice* finger = QTest::createTouchDevice();
  const auto middle = [&](const QString& name) {
    QQuickItem* item = below(window.window()->contentItem(), name);
    return item->mapToScene({item->width() / 2, item->height() / 2}).toPoint();
  };
  control.command_line()->set_open(true);
  QTest::qWait(600);
  const auto time = [&](const QPoint& at, bool at_release) {
    witness.forget();
    double begun = steady_ms();
    QTest::touchEvent(window.window(), finger).press(0, at, window.window());
    if (at_release) begun = steady_ms();
    QTest::touchEvent(window.window(), finger).release(0, at, window.window());
    const bool came = QTest::qWaitFor([&] { return witness.begun() > 0.0; }, kLimitMs);
    return came ? witness.begun() - begun : kLimitMs;
  };
  std::vector<double> taps, stops;
  for (int i = 0; i < kRepeats / 2; ++i) {
    control.command_line()->set_line("list");
    taps.push_back(time(middle("commandRun"), true));
    stops.push_back(time(middle("stopAll"), false));
    QTest::qWait(20);
  }
  results.emplace_back("tap to the station, median, ms", share_below(taps, 0.5));
  results.emplace_back("tap to the station, 99 %, ms", share_below(taps, 0.99));
  results.emplace_back("stop at finger-down to the station, median, ms", share_below(stops, 0.5));
  results.emplace_back("stop at finger-down to the station, 99 %, ms", share_below(stops, 0.99));
  return results;
}

}  // namespace adit::gui::bench

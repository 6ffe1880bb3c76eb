// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/gui/scene/camera_item.hpp"
#include "basestation/model/camera_bytes.hpp"
#include "basestation/model/json.hpp"
#include "perception/camera/picture.hpp"
#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {

/// A corridor in one colour, brighter at its end.
inline perception::Picture corridor(std::uint8_t red, std::uint8_t green) {
  perception::Picture out{.width = 320, .height = 240, .channels = 3};
  for (std::uint32_t y = 0; y < out.height; ++y)
    for (std::uint32_t x = 0; x < out.width; ++x) {
      const bool floor = y > 120 && x + 60 > 2 * (240 - y) && 380 - x > 2 * (240 - y);
      const bool end = y > 80 && y < 140 && x > 120 && x < 200;
      const auto shade = static_cast<std::uint8_t>(end ? 60 : floor ? 30 : 0);
      out.bytes.push_back(static_cast<std::uint8_t>(red + shade));
      out.bytes.push_back(static_cast<std::uint8_t>(green + shade));
      out.bytes.push_back(shade);
    }
  return out;
}

/// What the station answers to a request for pictures.
inline station::CommandOutcome outcome_of(const perception::Picture& pixels, std::uint64_t number,
                                          double age = 0.2, std::vector<std::uint8_t> missing = {},
                                          const std::string& robot = "r1") {
  station::CameraPicture picture{.robot = robot,
                                 .camera = "front",
                                 .number = number,
                                 .jpeg = perception::encode_jpeg(pixels, 80),
                                 .width = pixels.width,
                                 .height = pixels.height,
                                 .colour = true,
                                 .span = 10,
                                 .missing = std::move(missing),
                                 .age = age};
  return {.json = station::line_of(station::camera_json(picture))};
}

/// The window, and pictures of cameras as the station sends them.
class CameraWindow : public TabsTest {
 protected:
  void show_cameras() {
    station::World world = ten_robots();
    world.robots[0].cameras = {{.name = "front"}, {.name = "back"}};
    show(world);
  }
  void open_details() {
    show_cameras();
    control.select("r1", false);
    control.details()->set_open(true);
    settle_layout();
  }
  CameraItem* camera() { return qobject_cast<CameraItem*>(item("detailCamera")); }
  bool asked() {
    return QTest::qWaitFor([&] { return !sink.cameras.empty(); }, 10'000);
  }
  FakeSink::AskedCamera take() {
    FakeSink::AskedCamera out = std::move(sink.cameras.front());
    sink.cameras.erase(sink.cameras.begin());
    return out;
  }
  QColor colour_at(double x, double y) {
    settle();
    return window()->grabWindow().pixelColor(
        camera()->mapToScene({camera()->width() * x, camera()->height() * y}).toPoint());
  }
  QString caption() { return camera()->caption(); }
};

}  // namespace adit::gui

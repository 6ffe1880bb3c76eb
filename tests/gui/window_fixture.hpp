// SPDX-License-Identifier: Apache-2.0
// The whole window on Qt's software renderer, without a screen: commands end in a fake.
#pragma once
#include "tests/gui/fingers.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui {

class FakeSink : public CommandSink {
 public:
  void execute(const std::string& line, Done done) override {
    lines.push_back(line);
    pending.push_back(std::move(done));
  }
  void query(const std::string& line, Done done) override {
    queries.push_back(line);
    asked.emplace_back(line, std::move(done));
  }
  void camera(const station::CameraRequest& request, Done done) override {
    cameras.push_back({request, std::move(done)});
  }
  void photo(const std::string& id, findings::PhotoPart part, Done done) override {
    photos.push_back({id, part, std::move(done)});
  }
  void stop(const std::vector<std::string>& robots, Done done) override {
    std::string line = "STOP";
    for (const std::string& robot : robots) line += " " + robot;
    execute(line, std::move(done));
  }
  void start_station() override { ++starts; }
  void look_at(const std::optional<station::LookedAt>& place) override { looked = place; }

  std::vector<std::string> lines{};
  std::vector<Done> pending{};
  std::vector<std::string> queries{};
  std::vector<std::pair<std::string, Done>> asked{};  ///< Queries without an answer.
  struct AskedCamera {
    station::CameraRequest request{};
    Done done{};
  };
  std::vector<AskedCamera> cameras{};  ///< Pictures of cameras that were asked for.
  struct AskedPhoto {
    std::string id{};
    findings::PhotoPart part{};
    Done done{};
  };
  std::vector<AskedPhoto> photos{};  ///< Photos that were asked for.
  int starts{};
  std::optional<station::LookedAt> looked{};
};

class Window : public Fingers {
 protected:
  Window() {
    // What the state alone shows becomes an alert when it lasts.
    for (int i = 0; i < 4; ++i) show(ten_robots());
    control.show_map(std::make_shared<station::TileMap>(corridors()));
    open(control);
  }
  ~Window() override { operator_window.reset(); }  // It is shown by the control.

  void show(const station::World& world) {
    control.show(std::make_shared<station::World>(world), now += 0.2);
  }

  FakeSink sink{};
  Control control{sink};
  double now{100.0};
};

}  // namespace adit::gui

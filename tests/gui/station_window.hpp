// SPDX-License-Identifier: Apache-2.0
// A window of an operator's real station. Include it after what is not Qt's: Qt's keywords are macros.
#pragma once
#include "basestation/gui/bridge/qt_station.hpp"
#include "tests/folders/folders.hpp"
#include "tests/gui/fingers.hpp"

namespace adit::gui {

class StationWindow : public Fingers {
 protected:
  ~StationWindow() override { close_window(); }
  void close_window() {
    operator_window.reset();
    control.reset();
    qt_station.reset();
  }
  /// Opens the window of that operator's station, and starts one if none runs.
  void open_station(const std::string& operator_name, std::optional<unsigned> domain = std::nullopt) {
    station::client::StationOptions options;
    options.name = operator_name;
    if (domain) options.domain = *domain;
    options.program = program_folder() + "/basestation";
    auto opened = station::client::Station::open(options, "adit_gui");
    ASSERT_TRUE(opened) << opened.error().text;
    qt_station = std::make_unique<QtStation>(std::move(*opened));
    control = std::make_unique<Control>(*qt_station);
    qt_station->show_in(*control);
    control->drive()->use(*qt_station, [] { return [] { return station::input::Gamepad::State{}; }; });
    open(*control);
  }

  std::unique_ptr<QtStation> qt_station{};
  std::unique_ptr<Control> control{};
};

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
// The program adit_gui: parses the options, then shows the window.
#include <CLI/CLI.hpp>
#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QQuickWindow>
#include <QTimer>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "basestation/client/arguments.hpp"
#include "basestation/client/options.hpp"
#include "basestation/client/station.hpp"
#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/bridge/qt_station.hpp"
#include "basestation/gui/window.hpp"
#include "basestation/model/outcome.hpp"
#include "core/config/usage.hpp"

namespace adit::gui {
namespace {

struct Options {
  station::client::StationOptions station{};
  std::string screenshot{};
  double after{3.0};  ///< Time until the screenshot, s.
  std::string size{"1280x720"};
  std::vector<std::string> select{};
  WindowKind window{WindowKind::main};
  bool light{false};
  bool camera{false};  ///< Shows the picture of the selected robot's camera.
};

int fail(int code, const std::string& text) {
  std::fprintf(stderr, "adit_gui: %s\n", text.c_str());
  return code;
}

/// Reads the options; returns the exit status if the program has nothing more to do.
std::optional<int> read_options(int argc, char** argv, Options& options) {
  CLI::App app{"The operator's window on a team of robots. It starts the operator's station if none runs."};
  app.set_help_flag("-h,--help", "This help");
  app.set_version_flag("--version", ADIT_VERSION, "The version");
  app.option_defaults()->always_capture_default();
  station::client::StationArguments arguments(app, options.station);
  std::string window = "main";
  app.add_option("--window", window, "main, or map: the map and all cameras, for a second screen")
      ->check(CLI::IsMember({"main", "map"}));
  app.add_option("--select", options.select, "Robots that are selected at the start, may be repeated")
      ->allow_extra_args(false);
  app.add_option("--screenshot", options.screenshot, "Write a picture of the window (.png) and end");
  app.add_option("--after", options.after, "Time until the picture, s")
      ->check(config::between(0.0, 86400.0))
      ->needs("--screenshot");
  app.add_option("--size", options.size, "Size of the window, WIDTHxHEIGHT in pixels");
  app.add_flag("--light", options.light, "Light theme, for sunlight; Ctrl+L changes it");
  app.add_flag("--camera", options.camera,
               "Show the picture of the selected robot's camera, as the key C does")
      ->needs("--select");
  app.footer(
      "Examples:\n"
      "  adit_gui                                   the window of op1 on this machine\n"
      "  adit_gui --name op2 --link wifi --interface 10.0.0.4\n"
      "  adit_gui --select r2 --camera              r2 is selected, its camera's picture is shown\n"
      "  adit_gui --window map --size 1920x1080     a second screen beside it: map, cameras, stop of all\n"
      "  adit_gui --screenshot window.png --after 5 --size 1920x1080\n"
      "  QT_QPA_PLATFORM=offscreen QT_QUICK_BACKEND=software adit_gui --screenshot window.png   without a "
      "screen");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::printf("%s\n", app.help().c_str());
    return station::kExitDone;
  } catch (const CLI::CallForVersion&) {
    std::printf("%s\n", ADIT_VERSION);
    return station::kExitDone;
  } catch (const CLI::ParseError& error) {
    return fail(station::kExitUsage, std::string(error.what()) + "; try --help");
  }
  if (window == "map") options.window = WindowKind::map;
  if (const auto good = arguments.finish(); !good) return fail(station::kExitUsage, good.error().text);
  return std::nullopt;
}

std::optional<QSize> size_of(const std::string& text) {
  const QStringList parts = QString::fromStdString(text).split('x');
  const QSize size(parts.value(0).toInt(), parts.value(1).toInt());
  const bool good = parts.size() == 2 && size.width() >= 800 && size.height() >= 500 &&
                    size.width() <= 8000 && size.height() <= 8000;
  return good ? std::optional(size) : std::nullopt;
}

/// The program of the station, which stands beside this one.
std::string station_program() {
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  return failed ? "basestation" : (self.parent_path() / "basestation").string();
}

/// Qt ends the program without a screen, and names plugins; this says what to do.
bool has_screen() {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"})
    if (const char* value = std::getenv(variable); value && *value != 0) return true;
  return false;
}

/// Whether the machine draws by a GPU: false without OpenGL 3.3, or where the processor computes it.
bool has_gpu() {
  QOffscreenSurface surface;
  surface.create();
  QOpenGLContext context;
  if (!surface.isValid() || !context.create() || !context.makeCurrent(&surface)) return false;
  const auto* name = reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER));
  const QString renderer = QString::fromUtf8(name ? name : "unknown");
  const std::pair<int, int> version = context.format().version();
  context.doneCurrent();
  for (const char* processor : {"llvmpipe", "softpipe", "SwiftShader"})
    if (renderer.contains(processor, Qt::CaseInsensitive)) return false;
  constexpr std::pair kOldest{3, 3};
  return version >= kOldest || context.isOpenGLES();
}

int show_window(int argc, char** argv, const Options& options, const QSize& size) {
  const QGuiApplication app(argc, argv);
  QGuiApplication::setApplicationDisplayName("Adit " + QString::fromStdString(options.station.name));
  // Without a GPU, Qt's own renderer paints only what changed, where OpenGL by the processor paints complete
  // frames.
  const bool by_gpu = !qEnvironmentVariableIsSet("QT_QUICK_BACKEND") && has_gpu();
  if (!qEnvironmentVariableIsSet("QT_QUICK_BACKEND") && !by_gpu)
    QQuickWindow::setGraphicsApi(QSGRendererInterface::Software);
  auto station = station::client::Station::open(options.station, "adit_gui");
  if (!station)
    return fail(station.error().reason == Reason::bad_argument ? station::kExitUsage : station::kExitNoAnswer,
                station.error().text);
  QtStation qt_station(std::move(*station));
  const bool maps = options.window == WindowKind::map;
  Control control(qt_station, maps ? Control::Orders::view_only : Control::Orders::all);
  control.tabs()->settings()->open(WindowSettings::default_file(), options.light);
  qt_station.show_in(control);
  // The sticks belong to the main window.
  if (!maps)
    control.drive()->use(qt_station, [mapping = control.tabs()->settings()->pad()] {
      auto gamepad = std::make_shared<station::input::Gamepad>(mapping);
      InputThread::Pad pad([gamepad] { return gamepad->read(); });
      pad.rumble = [gamepad](double strength, std::chrono::milliseconds duration) {
        gamepad->rumble(strength, duration);
      };
      return pad;
    });
  for (const std::string& robot : options.select) control.select(QString::fromStdString(robot), true);
  constexpr int kWide = 1600;  // There is room for the details beside the map.
  control.details()->set_camera_on(options.camera);
  control.details()->set_open((size.width() >= kWide || options.camera) && !maps);
  control.set_solid(maps && by_gpu);
  const OperatorWindow window(control, options.window);
  if (!window.window())
    return fail(station::kExitRefused, "the window's files could not be loaded, see above");
  window.window()->resize(size);
  window.window()->show();
  if (!options.screenshot.empty())
    QTimer::singleShot(static_cast<int>(options.after * 1000), &app, [&] {
      const QImage picture = window.window()->grabWindow();
      const bool written = !picture.isNull() && picture.save(QString::fromStdString(options.screenshot));
      if (!written) fail(station::kExitRefused, "cannot write the picture " + options.screenshot);
      QGuiApplication::exit(written ? station::kExitDone : station::kExitRefused);
    });
  return QGuiApplication::exec();
}

int run_program(int argc, char** argv) {
  Options options;
  if (const std::optional<int> status = read_options(argc, argv, options)) return *status;
  const std::optional<QSize> size = size_of(options.size);
  if (!size)
    return fail(station::kExitUsage, "--size is WIDTHxHEIGHT, at least 800x500, as in --size 1920x1080");
  if (!has_screen())
    return fail(station::kExitUsage,
                "there is no screen: run it under one, or with QT_QPA_PLATFORM=offscreen "
                "QT_QUICK_BACKEND=software for --screenshot");
  options.station.program = station_program();
  return show_window(argc, argv, options, *size);
}

}  // namespace
}  // namespace adit::gui

int main(int argc, char** argv) { return adit::gui::run_program(argc, argv); }

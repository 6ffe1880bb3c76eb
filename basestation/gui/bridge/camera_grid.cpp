// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/camera_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "basestation/client/connection.hpp"
#include "basestation/gui/bridge/control.hpp"
#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

QList<QByteArray> tile_keys() {
  return {"tile",  "robot", "camera", "role", "sharp", "asks",
          "limit", "rate",  "why",    "load", "shape", "token"};
}

QVariantList tile_of(const PlannedCamera& camera) {
  constexpr std::array kRoles{"sharp", "thumbnail", "queued", "refused", "off", "lost"};
  constexpr std::array kShapes{"", "", "ring", "triangle", "", "square"};
  constexpr std::array kTokens{Token::text, Token::text, Token::goal, Token::warn, Token::dim, Token::bad};
  const auto role = static_cast<std::size_t>(camera.role);
  const auto& [robot, name] = camera.name;
  const std::string load =
      camera.bytes > 0.0F ? station::fixed(8e-3 * static_cast<double>(camera.bytes), 1) + " kbit/s" : "";
  return {text_of(robot + '\n' + name),
          text_of(robot),
          text_of(name),
          kRoles[role],
          camera.sharp,
          camera.rate > 0.0F,
          int{camera.width},
          std::max(camera.rate, 0.1F),
          text_of(camera.why),
          text_of(load),
          kShapes[role],
          word_of(kTokens[role])};
}

}  // namespace

CameraGrid::CameraGrid(Control& control)
    : QObject(&control), control_(control), tiles_(tile_keys(), this), large_(tile_keys(), this) {
  seen_.setSingleShot(true);
  connect(&seen_, &QTimer::timeout, this, &CameraGrid::refresh);
  turns_.setInterval(kTurnMs);
  connect(&turns_, &QTimer::timeout, this, [this] {
    ++turn_;
    refresh();
  });
}

void CameraGrid::watch(bool shown) {
  watchers_ += shown ? 1 : -1;
  control_.tabs()->watch_network(shown);
  is_shown() ? turns_.start() : turns_.stop();
  refresh();
}

void CameraGrid::follow_selection() {
  const std::vector<std::string>& selection = control_.selection();
  const std::string selected = selection.empty() ? "" : selection.back();
  const station::Robot* robot = control_.world().robot(selected);
  if (selected != std::exchange(selected_, selected) && robot && !robot->cameras.empty() &&
      sharp_.first != selected)
    sharp_ = {selected, robot->cameras.front().name};
  const auto known = [&](const CameraName& name) {
    const station::Robot* owner = control_.world().robot(name.first);
    return owner && std::ranges::count(owner->cameras, name.second, &station::CameraStatus::name) > 0;
  };
  if (known(sharp_)) return;
  for (const station::Robot& first : control_.world().robots)
    if (!first.cameras.empty() && !first.lost) {
      sharp_ = {first.name, first.cameras.front().name};
      return;
    }
}

void CameraGrid::refresh() {
  if (!is_shown()) return;
  follow_selection();
  plan_ = camera_plan({.world = &control_.world(),
                       .net = &control_.tabs()->net(),
                       .sharp = sharp_,
                       .off = off_,
                       .in_sight = &in_sight_,
                       .turn = turn_});
  std::vector<QVariantList> rows;
  std::vector<QVariantList> large;
  for (const PlannedCamera& camera : plan_.cameras) {
    rows.push_back(tile_of(camera));
    if (camera.sharp) large.push_back(rows.back());
  }
  tiles_.show(std::move(rows));
  large_.show(std::move(large));
  emit changed();
}

QString CameraGrid::without() const {
  QStringList names;
  for (const std::string& name : plan_.without) names << text_of(name);
  if (plan_.cameras.empty())
    return names.isEmpty() ? "no robot was heard yet"
                           : "no camera: no robot has one (docs/cameras.md names them)";
  return names.isEmpty() ? QString() : "no camera: " + names.join(" ");
}

QSizeF CameraGrid::tileFor(int tiles, double width, double height, double mm) const {
  constexpr double kMinWidth = 37.0;  // So that the words of a tile can be read, mm.
  constexpr double kLines = 12.0;     // Of name, age and load, and the gap to the next tile, mm.
  constexpr double kMinShape = 0.38, kShape = 0.62;  // Height of the picture by its width.
  const int most = std::max(1, static_cast<int>(width / (kMinWidth * mm)));
  for (int columns = 1;; ++columns) {
    const int rows = std::max(1, (tiles + columns - 1) / columns);
    const double wide = std::floor(width / columns);
    const double low = std::ceil(kMinShape * wide + kLines * mm),
                 high = std::ceil(kShape * wide + kLines * mm);
    if (columns < most && rows * low > height) continue;
    return {wide, std::clamp(std::floor(height / rows), low, high)};
  }
}

void CameraGrid::see(const QString& robot, const QString& camera, bool in_sight) {
  const CameraName name{robot.toStdString(), camera.toStdString()};
  if (in_sight)
    in_sight_.insert(name);
  else if (const auto one = in_sight_.find(name); one != in_sight_.end())
    in_sight_.erase(one);
  // Tiles appear while their list changes, and while it scrolls.
  if (!seen_.isActive()) seen_.start(kSeenMs);
}

void CameraGrid::choose(const QString& robot, const QString& camera) {
  sharp_ = {robot.toStdString(), camera.toStdString()};
  refresh();
}

void CameraGrid::step(int by) {
  if (!is_shown() || plan_.cameras.empty()) return;
  const auto now = std::ranges::find_if(plan_.cameras, &PlannedCamera::sharp);
  const auto count = static_cast<std::ptrdiff_t>(plan_.cameras.size());
  const auto at = now == plan_.cameras.end() ? 0 : now - plan_.cameras.begin() + by;
  sharp_ = plan_.cameras[static_cast<std::size_t>((at % count + count) % count)].name;
  refresh();
}

void CameraGrid::set_off(const CameraName& camera, bool off) {
  off ? (void)off_.insert(camera) : (void)off_.erase(camera);
  refresh();
}

void CameraGrid::switchOn(const QString& robot, const QString& camera, bool on) {
  const CameraName name{robot.toStdString(), camera.toStdString()};
  if (control_.silent())
    return control_.say("Not sent, as the station is silent: camera " + robot, "refused");
  if (!on && !off_.contains(name)) ending_.insert(name);
  set_off(name, !on);  // At once: a picture that is asked for would switch it on again.
  // What the grid asks for switches a camera on. `camera R on` would keep it on where the grid asks for
  // nothing.
  if (!on) control_.order(station::client::quoted({"camera", name.first, "off", name.second}));
}

void CameraGrid::add_command(const station::CommandEvent& event) {
  if (!event.ended || !event.line.starts_with("camera ")) return;
  const QStringList words = text_of(event.line).split(' ', Qt::SkipEmptyParts);
  const QString what = words.value(2);
  const station::Robot* robot = control_.world().robot(words.value(1).toStdString());
  if (!robot || robot->cameras.empty() || (what != "on" && what != "off")) return;
  const CameraName name{robot->name, words.size() > 3 ? words[3].toStdString() : robot->cameras.front().name};
  const bool done = event.exit_code == station::kExitDone;
  const bool ending = ending_.erase(name) > 0;
  if (what == "on" || done)
    set_off(name, what == "off");
  else if (ending)
    set_off(name, false);  // The camera still sends.
}

}  // namespace adit::gui

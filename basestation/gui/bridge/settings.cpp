// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/settings.hpp"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QSaveFile>
#include <algorithm>
#include <cmath>

#include "basestation/gui/scene/theme.hpp"

namespace adit::gui {
namespace {

constexpr qint64 kMaxFile = 64 * 1024;

}  // namespace

WindowSettings::WindowSettings(QObject* parent) : QObject(parent) {
  // The theme also changes by a key.
  connect(&Theme::instance(), &Theme::changed, this, [this] {
    if (!applying_) store();
    emit changed();
  });
}

QString WindowSettings::default_file() {
  const QString folder = qEnvironmentVariable("XDG_CONFIG_HOME");
  return (QDir::isAbsolutePath(folder) ? folder : QDir::homePath() + "/.config") + "/adit/gui.yaml";
}

SettingsRead WindowSettings::read() {
  QFile in(file_);
  SettingsRead out{.values = values(), .pad = pad_};
  if (!in.exists()) return out;
  if (!in.open(QIODevice::ReadOnly) || in.size() > kMaxFile)
    out.problems = {(in.isOpen() ? "too long for settings" : in.errorString()).toStdString()};
  else
    out = read_settings(in.readAll().toStdString());
  return out;
}

void WindowSettings::open(const QString& file, bool light) {
  file_ = file;
  const SettingsRead from = read();
  pad_ = from.pad;
  for (const std::string& problem : from.problems)
    emit remark(file + (problem.starts_with("line") ? ", " : ": ") + QString::fromStdString(problem));
  applying_ = true;
  apply(from.values);
  if (light) Theme::instance().set_light(true);
  applying_ = false;
  known_ = values();
  emit changed();
}

SettingsValues WindowSettings::values() {
  const Theme& theme = Theme::instance();
  return {.light = theme.light(), .glove = theme.glove(), .scale = theme.scale()};
}

void WindowSettings::apply(const SettingsValues& values) {
  Theme& theme = Theme::instance();
  theme.set_light(values.light);
  theme.set_glove(values.glove);
  theme.set_scale(values.scale);
}

void WindowSettings::store(bool all) {
  if (file_.isEmpty()) return;
  const SettingsRead from = read();
  if (!from.problems.empty()) {  // What is not understood is preserved.
    QFile::remove(file_ + ".bad");
    if (QFile::rename(file_, file_ + ".bad")) emit remark("what was wrong is preserved in " + file_ + ".bad");
  }
  const SettingsValues here = values();
  SettingsValues next = from.values;
  if (all || here.light != known_.light) next.light = here.light;
  if (all || here.glove != known_.glove) next.glove = here.glove;
  if (all || here.scale != known_.scale) next.scale = here.scale;
  QDir().mkpath(QFileInfo(file_).path());
  QSaveFile out(file_);
  const bool stored = out.open(QIODevice::WriteOnly) &&
                      out.write(QByteArray::fromStdString(settings_text(next, from.pad))) > 0 && out.commit();
  if (stored) known_ = here;
  if (!stored) emit remark("settings are not stored: " + file_ + ": " + out.errorString());
}

double WindowSettings::scale() const { return Theme::instance().scale(); }

void WindowSettings::set_scale(double scale) {
  constexpr double kSteps = 20.0;  // A step is 0.05.
  if (!std::isfinite(scale)) return;
  Theme::instance().set_scale(
      std::clamp(std::round(scale * kSteps) / kSteps, SettingsValues::kMinScale, SettingsValues::kMaxScale));
}

void WindowSettings::restoreDefaults() {
  applying_ = true;
  apply({});
  applying_ = false;
  store(true);
  emit changed();
}

}  // namespace adit::gui

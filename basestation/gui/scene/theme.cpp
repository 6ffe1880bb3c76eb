// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/theme.hpp"

#include <QGuiApplication>
#include <QJSEngine>
#include <QScreen>

namespace adit::gui {

Theme::Theme() {
  constexpr double kUsual = 96.0 / 25.4;  // Pixels per mm where the screen states no size, or an absurd one.
  const QScreen* screen = QGuiApplication::primaryScreen();
  const double stated = screen ? screen->physicalDotsPerInch() / 25.4 : 0.0;
  mm_ = stated > 3.0 && stated < 12.0 ? stated : kUsual;
}

Theme& Theme::instance() {
  static Theme theme;
  return theme;
}

Theme* Theme::create(QQmlEngine*, QJSEngine*) {
  QJSEngine::setObjectOwnership(&instance(), QJSEngine::CppOwnership);
  return &instance();
}

void Theme::set_light(bool light) {
  if (light == light_) return;
  light_ = light;
  emit changed();
}

void Theme::set_glove(bool glove) {
  if (glove == glove_) return;
  glove_ = glove;
  emit changed();
}

void Theme::set_scale(double scale) {
  if (scale == scale_) return;
  scale_ = scale;
  emit changed();
}

}  // namespace adit::gui

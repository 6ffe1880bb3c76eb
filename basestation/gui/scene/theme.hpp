// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QColor>
#include <QObject>

#include "basestation/gui/scene/colours.hpp"

class QJSEngine;
class QQmlEngine;

namespace adit::gui {

/// Colours and sizes of the window. One for the program; QML knows it as the singleton `Theme`.
class Theme : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_SINGLETON
  Q_PROPERTY(bool light READ light WRITE set_light NOTIFY changed)
  Q_PROPERTY(double mm READ mm NOTIFY changed)
  Q_PROPERTY(bool glove READ glove WRITE set_glove NOTIFY changed)
  Q_PROPERTY(QColor ground READ ground NOTIFY changed)
  Q_PROPERTY(QColor panel READ panel NOTIFY changed)
  Q_PROPERTY(QColor raised READ raised NOTIFY changed)
  Q_PROPERTY(QColor edge READ edge NOTIFY changed)
  Q_PROPERTY(QColor text READ text NOTIFY changed)
  Q_PROPERTY(QColor dim READ dim NOTIFY changed)
  Q_PROPERTY(QColor ink READ ink CONSTANT)
  Q_PROPERTY(QColor ok READ ok CONSTANT)
  Q_PROPERTY(QColor warn READ warn CONSTANT)
  Q_PROPERTY(QColor bad READ bad CONSTANT)
  Q_PROPERTY(QColor mine READ mine CONSTANT)
  Q_PROPERTY(QColor other READ other CONSTANT)
  Q_PROPERTY(QColor none READ none CONSTANT)
  Q_PROPERTY(QColor goal READ goal CONSTANT)

 public:
  static Theme& instance();
  static Theme* create(QQmlEngine*, QJSEngine*);  ///< For QML.

  bool light() const { return light_; }
  void set_light(bool light);
  /// Pixels per mm, as the operator set it. With gloves everything is larger, so that the buttons of the
  /// action bar are 20 mm high in place of 13 mm.
  double mm() const { return mm_ * scale_ * (glove_ ? kGlove : 1.0); }
  bool glove() const { return glove_; }
  void set_glove(bool glove);
  double scale() const { return scale_; }
  void set_scale(double scale);  ///< Of what the screen states.
  const Palette& palette() const { return light_ ? kLight : kDark; }
  QColor of(Token token) const { return QColor::fromRgb(colour(token, palette())); }

  QColor ground() const { return QColor::fromRgb(palette().ground); }
  QColor panel() const { return QColor::fromRgb(palette().panel); }
  QColor raised() const { return QColor::fromRgb(palette().raised); }
  QColor edge() const { return QColor::fromRgb(palette().edge); }
  QColor text() const { return QColor::fromRgb(palette().text); }
  QColor dim() const { return QColor::fromRgb(palette().dim); }
  QColor ink() const { return QColor::fromRgb(kInk); }
  QColor ok() const { return of(Token::ok); }
  QColor warn() const { return of(Token::warn); }
  QColor bad() const { return of(Token::bad); }
  QColor mine() const { return of(Token::mine); }
  QColor other() const { return of(Token::other); }
  QColor none() const { return of(Token::none); }
  QColor goal() const { return of(Token::goal); }

 signals:
  void changed();

 private:
  Theme();

  static constexpr double kGlove = 20.0 / 13.0;

  bool light_{false}, glove_{false};
  double mm_{}, scale_{1.0};  ///< As the screen states it, and what the operator makes of it.
};

}  // namespace adit::gui

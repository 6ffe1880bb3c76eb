// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QTimer>
#include <map>
#include <memory>

#include "basestation/gui/bridge/input_thread.hpp"

namespace adit::gui {

class Control;

/// Driving by hand, for QML: one robot, whatever is selected.
class DriveControl : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  Q_PROPERTY(bool driving READ driving NOTIFY changed)
  Q_PROPERTY(QString robot READ robot NOTIFY changed)
  Q_PROPERTY(QString mode READ mode NOTIFY changed)
  Q_PROPERTY(QString asked READ asked NOTIFY changed)
  Q_PROPERTY(QString measured READ measured NOTIFY changed)
  Q_PROPERTY(QString age READ age NOTIFY changed)
  Q_PROPERTY(QString why READ why NOTIFY changed)
  /// The first camera of the driven robot; empty: it has none.
  Q_PROPERTY(QString camera READ camera NOTIFY changed)
  Q_PROPERTY(bool good READ good NOTIFY changed)
  Q_PROPERTY(bool held READ held NOTIFY changed)
  Q_PROPERTY(bool pad READ pad NOTIFY changed)

 public:
  static constexpr int kBeatMs = 50;

  explicit DriveControl(Control& control);
  /// Drives by way of that sink from now on. `make_pad`: see InputThread.
  void use(DriveSink& sink, std::function<InputThread::Pad()> make_pad);

  /// Lets go; nothing of the sink is used any more.
  void stop_using();

  /// Begins to drive that robot.
  void begin(const std::string& robot);
  Q_INVOKABLE void letGo();
  /// Software stop of the driven robot.
  Q_INVOKABLE void stopRobot();
  /// The stick of the screen: forward and turn to the left, [-1, 1], while a finger is on it.
  Q_INVOKABLE void touch(double forward, double turn);
  Q_INVOKABLE void release();
  /// Another mode by hand: smart_joystick or manual.
  Q_INVOKABLE void setMode(const QString& mode);
  /// A key while a robot is driven, and its place on the keyboard. True if it means something then.
  bool press(int key, int place);
  void release_key(int place);
  void forget_keys();
  /// Whether the window has the keyboard. Without it no hand drives.
  void set_focused(bool focused);
  /// Vibrates the game controller: strongly if motion or control is at stake.
  void warn_hand(bool strongly);

  bool driving() const { return !status_.robot.empty(); }
  QString robot() const { return QString::fromStdString(status_.robot); }
  QString camera() const;
  QString mode() const;
  QString asked() const;
  QString measured() const;
  QString age() const;
  QString why() const { return QString::fromStdString(status_.why); }
  bool good() const;  ///< Nothing keeps the hands from driving.
  bool held() const { return status_.dead_man; }
  bool pad() const { return status_.pad; }

 signals:
  void changed();

 private:
  void look();
  void send_keys();

  Control& control_;
  std::unique_ptr<InputThread> thread_{};
  InputThread::Status status_{};
  std::map<int, int> down_{};  ///< Keys that drive, by their places.
  bool focused_{true};
  QTimer timer_{};
};

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QBasicTimer>
#include <QElapsedTimer>
#include <QQuickItem>

namespace adit::gui {

/// The part of a button that a finger or the mouse presses. A touch and the mouse events that would follow
/// from it count once. A finger that leaves the item presses nothing.
class PressArea : public QQuickItem {
  Q_OBJECT
  QML_ELEMENT
  /// How long it is pressed until held(), ms; 0: it is tapped.
  Q_PROPERTY(int holdTime READ hold_time WRITE set_hold_time NOTIFY settings_changed)
  /// With a hold time: a shorter press taps, and is no press that was begun and not ended.
  Q_PROPERTY(bool tapsToo MEMBER taps_too_ NOTIFY settings_changed)
  /// What a press means. If it changes under the finger, or less than 0.4 s before, the press counts for
  /// nothing.
  Q_PROPERTY(QString meaning READ meaning WRITE set_meaning NOTIFY settings_changed)
  Q_PROPERTY(bool pressed READ pressed NOTIFY pressed_changed)
  Q_PROPERTY(double progress READ progress NOTIFY progress_changed)

 public:
  static constexpr int kSettle = 400;  ///< After `meaning` changed, ms.

  explicit PressArea(QQuickItem* parent = nullptr);
  bool pressed() const { return pressed_; }
  double progress() const { return progress_; }  ///< Of holding, [0, 1].
  int hold_time() const { return hold_time_; }
  void set_hold_time(int milliseconds);
  const QString& meaning() const { return meaning_; }
  void set_meaning(const QString& meaning);

 signals:
  void settings_changed();
  void pressed_changed();
  void progress_changed();
  void down();            ///< At once as it is pressed.
  void tapped(bool add);  ///< `add`: with the shift key.
  void held();

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseUngrabEvent() override { cancel(); }
  void touchEvent(QTouchEvent* event) override;
  void touchUngrabEvent() override { cancel(); }
  void timerEvent(QTimerEvent* event) override;

 private:
  void press();
  void move(const QPointF& at);
  void release(const QPointF& at, bool add);
  void cancel();
  void set_progress(double progress);

  int hold_time_{0};
  bool taps_too_{false};
  QString meaning_{};
  QElapsedTimer changed_{};
  QBasicTimer timer_{};
  QElapsedTimer since_{};
  bool pressed_{false};
  double progress_{0.0};
};

}  // namespace adit::gui

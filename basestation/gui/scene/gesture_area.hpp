// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QBasicTimer>
#include <QElapsedTimer>
#include <QQuickItem>
#include <algorithm>
#include <functional>

namespace adit::gui {

/// Recognises what fingers and the mouse do on the map, from raw events: Qt 6.4's handlers lose fingers of
/// several, and a Flickable around the map would take them. A third finger is a palm: everything is ignored
/// until all are up.
class GestureArea : public QQuickItem {
  Q_OBJECT
  QML_ANONYMOUS

 public:
  static constexpr int kLongPress = 600;   ///< Time until a press means a place to drive to, ms.
  static constexpr int kGlovePress = 800;  ///< The same in glove mode.
  static constexpr int kHold = 800;        ///< Time of a press that is held, ms.
  static constexpr double kSlopMm = 3.0;   ///< A finger that moves less has not moved.

  explicit GestureArea(QQuickItem* parent = nullptr);
  /// A place is shown that would be sent if the finger was lifted.
  bool aims() const { return state_ == State::aimed; }
  /// Time since the press began, ms. A test may replace it.
  std::function<qint64()> pressed_for{[this] { return since_.elapsed(); }};

 protected:
  /// Whether a tap means a place to drive to.
  virtual bool aiming() const = 0;
  /// Whether a drag draws a rectangle.
  virtual bool drawing() const { return false; }
  virtual double slop() const = 0;  ///< Pixels.
  virtual void tap(const QPointF& at, bool add) = 0;
  /// Whether what a place is sent to needs a press that is held.
  virtual bool needs_hold() const = 0;
  virtual void show_aim(const QPointF& at) = 0;  ///< The place that would be sent.
  virtual void drop_aim() = 0;
  /// `held`: it was pressed for kHold, or longer.
  virtual void send_aim(const QPointF& at, bool held) = 0;
  /// A rectangle from corner to corner; `done`: the finger was lifted.
  virtual void draw(const QPointF& /*from*/, const QPointF& /*to*/, bool /*done*/) {}
  virtual void drop_drawing() {}
  /// Whether a pinch only zooms until its middle has moved by the slop.
  virtual bool holds_place() const { return false; }
  virtual void pan(const QPointF& by) = 0;
  virtual void zoom(double factor, const QPointF& about) = 0;

  /// Takes back what a finger that is down would do when it is lifted.
  void drop_press();
  /// How much of kHold the present press has lasted, [0, 1].
  double held_share() const { return std::min(1.0, static_cast<double>(pressed_for()) / kHold); }
  const QPointF& pressed_at() const { return start_; }
  bool pinching() const { return state_ == State::pinching; }
  /// The mouse drags with its middle or right button, or with the shift key.
  bool sliding() const { return sliding_; }
  bool busy() const { return state_ != State::idle; }  ///< A finger or a button is down.

  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseUngrabEvent() override { cancel(); }
  void wheelEvent(QWheelEvent* event) override;
  void touchEvent(QTouchEvent* event) override;
  void touchUngrabEvent() override { cancel(); }
  void timerEvent(QTimerEvent* event) override;

 private:
  enum class State : std::uint8_t { idle, pressed, aimed, drawing, panning, pinching, ignored };

  void press(const QPointF& at, bool aim);
  void take_aim();
  void move(const QPointF& at);
  void release(const QPointF& at, bool add);
  void cancel();
  void pinch(const QPointF& first, const QPointF& second);
  void leave_press();

  State state_{State::idle};
  bool sliding_{false};
  QBasicTimer timer_{};  ///< Runs until a press means a place, and then for its ring.
  QElapsedTimer since_{};
  QPointF start_{}, last_{}, pinched_{};
  double spread_{};  ///< Distance between two fingers, pixels.
};

}  // namespace adit::gui

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QQuickItem>

namespace adit::gui {

/// A stick on the screen: it is held while a finger or the mouse is on it, and its axes are the way of the
/// finger from the middle, up to its edge.
class StickArea : public QQuickItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(bool held READ held NOTIFY moved)
  Q_PROPERTY(double forward READ forward NOTIFY moved)    ///< Up, [-1, 1].
  Q_PROPERTY(double leftward READ leftward NOTIFY moved)  ///< [-1, 1]

 public:
  explicit StickArea(QQuickItem* parent = nullptr);
  bool held() const { return held_; }
  double forward() const { return forward_; }
  double leftward() const { return left_; }

 signals:
  void moved();     ///< Also when it is pressed.
  void released();  ///< Also when the finger is lost.

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseUngrabEvent() override { let_go(); }
  void touchEvent(QTouchEvent* event) override;
  void touchUngrabEvent() override { let_go(); }
  void itemChange(ItemChange change, const ItemChangeData& data) override;

 private:
  void move(const QPointF& at);
  void let_go();

  bool held_{false};
  double forward_{}, left_{};
};

}  // namespace adit::gui

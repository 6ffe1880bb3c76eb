// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QQuickItem>
#include <QQuickWindow>

namespace adit::gui {

/// The item of that name below `top`, of several one that is shown if there is any; delegates have no parent
/// object but a parent item.
inline QQuickItem* item_below(QQuickItem* top, const QString& name) {
  QQuickItem* hidden = nullptr;
  for (QQuickItem* child : top->childItems()) {
    QQuickItem* found = child->objectName() == name ? child : item_below(child, name);
    if (found && found->isVisible()) return found;
    if (!hidden) hidden = found;
  }
  return hidden;
}

/// The item of that name in the window; null: there is none now.
inline QQuickItem* find_item(QQuickWindow* window, const QString& name) {
  auto* found = window->contentItem()->findChild<QQuickItem*>(name);
  return found ? found : item_below(window->contentItem(), name);
}

}  // namespace adit::gui

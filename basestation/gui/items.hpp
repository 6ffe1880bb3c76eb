// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QQuickItem>
#include <QQuickWindow>

namespace adit::gui {

/// The item of that name at or below `top`; delegates have no parent object but a parent item.
inline QQuickItem* item_below(QQuickItem* top, const QString& name) {
  for (QQuickItem* child : top->childItems()) {
    if (child->objectName() == name) return child;
    if (QQuickItem* found = item_below(child, name)) return found;
  }
  return nullptr;
}

/// The item of that name in the window; null: there is none now.
inline QQuickItem* find_item(QQuickWindow* window, const QString& name) {
  auto* found = window->contentItem()->findChild<QQuickItem*>(name);
  return found ? found : item_below(window->contentItem(), name);
}

}  // namespace adit::gui

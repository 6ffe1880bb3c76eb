// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// All that needs the operator, over the upper part of the map.
Rectangle {
    id: menu
    required property AttentionList attention
    visible: attention.open
    height: Math.min(list.contentHeight + 3 * Theme.mm, 80 * Theme.mm)
    color: Theme.panel
    border.width: 1
    border.color: Theme.edge

    PlainList {
        id: list
        objectName: "allNeeds"
        spacing: 1 * Theme.mm
        model: menu.visible ? menu.attention.rows : null
        delegate: AttentionItem {
            attention: menu.attention
            width: list.width
            height: Math.max(12 * Theme.mm, wantedHeight)
            maximumLines: 8
        }
    }
}

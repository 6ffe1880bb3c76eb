// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// What needs the operator, the most urgent first. What has no place opens below.
Rectangle {
    id: strip
    required property AttentionList attention
    readonly property int places: Math.max(1, Math.floor(list.width / (105 * Theme.mm)))
    color: Theme.ground

    PlainLabel {
        objectName: "attention"
        visible: strip.attention.count === 0
        anchors.fill: parent
        anchors.leftMargin: 3 * Theme.mm
        text: strip.attention.quiet
        color: Theme.dim
    }
    Item {
        id: list
        anchors.fill: parent
        anchors.margins: 1 * Theme.mm
        anchors.rightMargin: 22 * Theme.mm
        readonly property double place: width / strip.places
        Repeater {
            model: strip.attention.top
            AttentionItem {
                required property int index
                attention: strip.attention
                visible: index < strip.places
                x: index * list.place
                width: list.place - 1 * Theme.mm
                height: list.height
            }
        }
    }
    HoldButton {
        objectName: "moreNeeds"
        visible: strip.attention.count > strip.places
        anchors.right: parent.right
        anchors.rightMargin: 2 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
        width: 18 * Theme.mm
        height: list.height
        text: (strip.attention.open ? "▴ " : "▾ ") + strip.attention.count
        onFired: strip.attention.open = !strip.attention.open
    }
}

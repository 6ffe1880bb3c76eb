// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Which robots do nothing useful until somebody acts.
Rectangle {
    id: line
    required property Control control
    color: Theme.ground

    Glyph {
        id: mark
        visible: line.control.attention !== ""
        kind: "triangle"
        colour: Theme.warn
        outline: Theme.ink
        width: 4.4 * Theme.mm
        height: width
        x: 3 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
    }
    PlainLabel {
        objectName: "attention"
        anchors.fill: parent
        anchors.leftMargin: (mark.visible ? 9 : 3) * Theme.mm
        anchors.rightMargin: 2 * Theme.mm
        text: line.control.attention === "" ? "no robot needs you" : line.control.attention
        color: line.control.attention === "" ? Theme.dim : Theme.text
    }
}

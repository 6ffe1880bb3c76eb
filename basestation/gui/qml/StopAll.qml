// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Stops every robot as soon as a finger is down. It is at the same place in every state of the window.
Rectangle {
    id: stop
    required property Control control
    width: 44 * Theme.mm
    height: 20 * Theme.mm
    color: area.pressed ? Theme.warn : Theme.bad
    radius: 1 * Theme.mm
    border.width: 2
    border.color: Theme.ink

    Glyph {
        kind: "square"
        colour: Theme.ink
        outline: Theme.ink
        x: 2 * Theme.mm
        width: 6 * Theme.mm
        height: width
        anchors.verticalCenter: parent.verticalCenter
    }
    PlainLabel {
        x: 10 * Theme.mm
        y: 1.5 * Theme.mm
        width: parent.width - 11 * Theme.mm
        height: 9 * Theme.mm
        text: "SOFTWARE\nSTOP ALL"
        maximumLineCount: 2
        elide: Text.ElideNone
        color: Theme.ink
        font.bold: true
        font.pixelSize: 3.6 * Theme.mm
    }
    FittedLabel {
        objectName: "stopText"
        x: 10 * Theme.mm
        y: 10.4 * Theme.mm
        width: parent.width - 11 * Theme.mm
        height: 9 * Theme.mm
        wrapMode: Text.Wrap
        maximumLineCount: 2
        full: stop.control.stopText
        brief: stop.control.stopTextShort
        color: Theme.ink
    }
    PressArea {
        id: area
        objectName: "stopAll"
        anchors.fill: parent
        Accessible.role: Accessible.Button
        Accessible.name: "software stop of all robots"
        Accessible.onPressAction: stop.control.stopAll()
        onDown: stop.control.stopAll()
    }
}

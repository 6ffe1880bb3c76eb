// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A button that is tapped, or pressed and held until its ring is full.
Rectangle {
    id: button
    property string text
    property string spoken: text
    property bool hold: false
    property bool active: false
    property alias meaning: area.meaning
    signal fired(bool held)

    implicitWidth: label.implicitWidth + (hold ? 11 : 6) * Theme.mm
    implicitHeight: 8 * Theme.mm
    radius: 1 * Theme.mm
    color: area.pressed ? Theme.edge : active ? Theme.goal : Theme.raised
    border.width: 1
    border.color: Theme.edge

    PlainLabel {
        id: label
        anchors.fill: parent
        anchors.leftMargin: (button.hold ? 8 : 1) * Theme.mm
        anchors.rightMargin: 1 * Theme.mm
        horizontalAlignment: Text.AlignHCenter
        text: button.text
        color: button.active ? Theme.ink : Theme.text
    }
    Glyph {
        visible: button.hold
        kind: area.progress > 0 ? "pie" : "ring"
        progress: area.progress
        colour: area.progress > 0 ? Theme.goal : Theme.dim
        width: 5 * Theme.mm
        height: width
        x: 2 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
    }
    PressArea {
        id: area
        anchors.fill: parent
        Accessible.role: Accessible.Button
        Accessible.name: button.spoken
        Accessible.onPressAction: button.fired(false)
        holdTime: button.hold ? 800 : 0
        onTapped: button.fired(false)
        onHeld: button.fired(true)
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A place of the action bar: it fades where its action is not possible, and never moves.
Rectangle {
    id: button
    required property Control control
    required property int index
    required property string slot
    required property string label
    required property string key
    required property string hint
    required property string shortHint
    required property string names
    required property bool possible
    required property string touch
    required property string state_
    readonly property bool aims: slot === "goto" && control.aiming

    radius: 1 * Theme.mm
    opacity: possible ? 1 : 0.35
    color: area.pressed ? Theme.edge : aims ? Theme.goal : Theme.raised
    border.width: state_ === "" ? 1 : 3
    border.color: state_ === "sent" ? Theme.goal : state_ === "done" ? Theme.ok : state_ === "refused" ? Theme.bad : Theme.edge

    PlainLabel {
        objectName: "buttonLabel"
        x: 0.1 * Theme.mm
        y: -0.7 * Theme.mm
        width: parent.width - 2 * x
        height: 6 * Theme.mm
        horizontalAlignment: Text.AlignHCenter
        font.bold: true
        color: button.aims ? Theme.ink : Theme.text
        text: (button.state_ === "done" ? "✓ " : button.state_ === "refused" ? "✗ " : "") + button.label + (button.key === "" ? "" : " " + button.key)
    }
    FittedLabel {
        readonly property string how: button.possible && (button.touch === "hold" || button.touch === "place_held") ? "hold: " : ""
        objectName: "buttonHint"
        x: 0.5 * Theme.mm
        y: 4.4 * Theme.mm
        width: parent.width - 2 * x
        height: 8.6 * Theme.mm
        horizontalAlignment: Text.AlignHCenter
        wrapMode: Text.Wrap
        maximumLineCount: 2
        color: button.aims ? Theme.ink : Theme.dim
        full: how + (button.hint === "" ? button.names : button.hint)
        brief: how + button.shortHint
    }
    Rectangle {
        width: parent.width * area.progress
        height: 1.2 * Theme.mm
        anchors.bottom: parent.bottom
        color: Theme.goal
    }
    Glyph {
        visible: area.progress > 0
        kind: "pie"
        progress: area.progress
        colour: Theme.goal
        anchors.centerIn: parent
        width: 12 * Theme.mm
        height: width
    }
    PressArea {
        id: area
        objectName: "button_" + button.slot
        anchors.fill: parent
        Accessible.role: Accessible.Button
        Accessible.name: button.label
        Accessible.description: button.names
        Accessible.onPressAction: button.control.trigger(button.index, false)
        holdTime: button.possible && button.touch === "hold" ? 800 : 0
        meaning: button.label + button.hint + button.names + button.touch
        onTapped: button.control.trigger(button.index, false)
        onHeld: button.control.trigger(button.index, true)
    }
}

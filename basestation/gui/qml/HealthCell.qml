// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// One component of one robot, or the robot's name.
Rectangle {
    id: cell
    required property string robot
    required property string component
    required property string label
    required property string hint
    required property string shape
    required property string token
    required property bool old
    required property bool chosen
    signal chosenByTap
    color: area.pressed ? Theme.edge : component === "" || label === "" ? "transparent" : Theme.raised
    border.width: chosen ? 3 : 0
    border.color: Theme.goal
    opacity: old ? 0.6 : 1

    Glyph {
        id: mark
        visible: cell.shape !== ""
        x: 1.2 * Theme.mm
        y: 1.6 * Theme.mm
        width: 4 * Theme.mm
        height: width
        kind: cell.shape
        colour: cell.token === "ok" ? Theme.ok : cell.token === "warn" ? Theme.warn : cell.token === "bad" ? Theme.bad : Theme.text
        outline: Theme.ink
    }
    PlainLabel {
        x: (mark.visible ? 6.2 : 1) * Theme.mm
        y: 1 * Theme.mm
        width: parent.width - x - 1 * Theme.mm
        height: 5.4 * Theme.mm
        font.bold: cell.component === "" || cell.token === "bad"
        text: cell.label
    }
    PlainLabel {
        x: 1 * Theme.mm
        y: 6.6 * Theme.mm
        width: parent.width - 2 * Theme.mm
        height: 4.6 * Theme.mm
        font.pixelSize: 2.9 * Theme.mm
        color: Theme.dim
        text: cell.hint
    }
    PressArea {
        id: area
        objectName: "health_" + cell.robot + "_" + cell.component
        anchors.fill: parent
        Accessible.role: Accessible.Button
        Accessible.name: cell.robot + " " + cell.component + " " + cell.label
        Accessible.onPressAction: cell.chosenByTap()
        enabled: cell.component !== "" && cell.label !== ""
        onTapped: cell.chosenByTap()
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: row
    required property TabState state_
    required property int number
    required property string direction
    required property double turn
    required property string steps
    required property string floors
    required property string step
    required property string breadth
    required property string robots
    required property string verdict
    required property string climbers
    required property string others
    required property string token
    readonly property double half: (width - 115 * Theme.mm) / 2
    height: 13 * Theme.mm
    color: Theme.raised
    opacity: verdict === "rejected" ? 0.6 : 1
    border.width: state_.pickedFinding === number ? 2 : 0
    border.color: Theme.text
    component Upper: PlainLabel {
        y: 0.8 * Theme.mm
        height: 6 * Theme.mm
    }
    component Lower: PlainLabel {
        y: 6.4 * Theme.mm
        height: 6 * Theme.mm
        color: Theme.dim
    }

    PressArea {
        objectName: "staircase_" + row.number
        anchors.fill: parent
        meaning: "stairs" + row.number
        onTapped: row.state_.pickStairs(row.number)
        Accessible.role: Accessible.Button
        Accessible.name: row.number + " stairs, " + row.steps
        Accessible.onPressAction: row.state_.pickStairs(row.number)
    }
    Glyph {
        x: 1 * Theme.mm
        y: 3.8 * Theme.mm
        width: 5.4 * Theme.mm
        height: width
        rotation: row.turn
        kind: "arrow"
        colour: row.token === "ok" ? Theme.ok : row.token === "dim" ? Theme.dim : Theme.text
        outline: Theme.ink
    }
    Upper { x: 7 * Theme.mm; width: 15 * Theme.mm; font.bold: true; text: row.number }
    Lower { x: 7 * Theme.mm; width: 15 * Theme.mm; text: row.direction }
    Upper { x: 23 * Theme.mm; width: 35 * Theme.mm; font.bold: true; text: row.steps }
    Lower { x: 23 * Theme.mm; width: 35 * Theme.mm; text: row.floors }
    Upper { x: 59 * Theme.mm; width: 43 * Theme.mm; text: row.step }
    Lower { x: 59 * Theme.mm; width: 43 * Theme.mm; text: row.breadth }
    Upper { objectName: "seenBy"; x: 103 * Theme.mm; width: row.half; text: row.robots }
    Lower { x: 103 * Theme.mm; width: row.half; text: row.verdict }
    Upper { objectName: "climbers"; x: 103 * Theme.mm + row.half; width: row.half + 10 * Theme.mm; font.bold: true; text: row.climbers }
    Lower { objectName: "climbers"; x: 103 * Theme.mm + row.half; width: row.half + 10 * Theme.mm; text: row.others }
}

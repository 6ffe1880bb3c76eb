// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Who hears whom: a row for each hearer, a column for each speaker.
Matrix {
    id: wide
    required property TabState state_
    objectName: "hearing"
    minimumPlace: 24 * Theme.mm
    corner: "↓ hears →"
    bold: true
    columns: state_.speakers
    columnCount: state_.speakerCount
    cells: state_.hearing
    cellHeight: 8 * Theme.mm
    delegate: Rectangle {
        id: cell
        required property string name
        required property string label
        required property string shape
        required property string token
        width: wide.place - 1
        height: 8 * Theme.mm - 1
        color: shape === "" ? "transparent" : Theme.raised
        Glyph {
            visible: cell.shape !== ""
            x: 1 * Theme.mm
            anchors.verticalCenter: parent.verticalCenter
            width: 3.6 * Theme.mm
            height: width
            kind: cell.shape
            colour: cell.token === "ok" ? Theme.ok : cell.token === "warn" ? Theme.warn : Theme.bad
            outline: Theme.ink
        }
        PlainLabel {
            x: (cell.shape === "" ? 1 : 5.6) * Theme.mm
            width: parent.width - x
            height: parent.height
            font.bold: cell.name !== ""
            text: cell.label
        }
    }
}

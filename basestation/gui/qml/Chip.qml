// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A word on a coloured ground, with the mark of its state.
Rectangle {
    id: chip
    property string text
    property string brief: text
    property string shape
    property color fill: Theme.none

    // Of the text itself: the width of the row follows the chip's.
    implicitWidth: label.fullWidth + (shape === "" ? 2.4 : 6.8) * Theme.mm
    implicitHeight: 5 * Theme.mm
    radius: 0.8 * Theme.mm
    color: fill
    border.width: Theme.light ? 1 : 0
    border.color: Theme.ink

    Row {
        anchors.centerIn: parent
        width: Math.min(implicitWidth, chip.width - 1.6 * Theme.mm)
        spacing: 1 * Theme.mm
        Glyph {
            visible: chip.shape !== ""
            kind: chip.shape
            colour: Theme.ink
            outline: Theme.ink
            width: 3.4 * Theme.mm
            height: width
            anchors.verticalCenter: parent.verticalCenter
        }
        FittedLabel {
            id: label
            objectName: "headlineText"
            full: chip.text
            brief: chip.brief
            color: Theme.ink
            font.bold: true
            width: Math.min(fullWidth, chip.width - (chip.shape === "" ? 1.6 : 6) * Theme.mm)
        }
    }
}

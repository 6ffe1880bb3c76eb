// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: bar
    required property Control control
    readonly property double place: (width - who.width - 4 * Theme.mm) / Math.max(1, slots.count)
    color: Theme.panel

    PlainLabel {
        id: who
        objectName: "selection"
        x: 3 * Theme.mm
        width: 30 * Theme.mm
        height: parent.height
        wrapMode: Text.Wrap
        maximumLineCount: 3
        font.bold: true
        color: bar.control.selectionText === "" ? Theme.dim : Theme.text
        text: bar.control.selectionText === "" ? "select a robot" : bar.control.selectionText
    }
    Repeater {
        id: slots
        model: bar.control.buttons
        ActionButton {
            control: bar.control
            x: who.x + who.width + index * bar.place
            y: 1.5 * Theme.mm
            width: bar.place - 2 * Theme.mm
            height: bar.height - 3 * Theme.mm
        }
    }
}

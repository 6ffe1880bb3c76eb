// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Why actions are not possible now, and what would change that.
Rectangle {
    id: reasons
    required property Control control
    visible: control.reasonsOpen && control.refusalCount > 0
    height: Math.min(list.contentHeight + 3 * Theme.mm, 62 * Theme.mm)
    color: Theme.panel
    border.width: 1
    border.color: Theme.edge

    PlainList {
        id: list
        objectName: "reasons"
        model: reasons.control.refusals
        delegate: Item {
            id: line
            required property int index
            required property string label
            required property string names
            required property string why
            required property string cureLabel
            required property string cureLine
            required property bool cureHold
            width: list.width
            height: Math.max(10 * Theme.mm, reason.implicitHeight + 2 * Theme.mm)
            PlainLabel {
                id: reason
                objectName: "reason"
                x: 2 * Theme.mm
                width: (cure.visible ? cure.x : parent.width) - 4 * Theme.mm
                anchors.verticalCenter: parent.verticalCenter
                wrapMode: Text.Wrap
                maximumLineCount: 10
                text: line.label + "  —  " + line.names + ": " + line.why
            }
            HoldButton {
                id: cure
                objectName: "cure_" + line.index
                visible: line.cureLabel !== ""
                x: parent.width - width
                y: 0.5 * Theme.mm
                height: 9 * Theme.mm
                text: line.cureLabel
                hold: line.cureHold
                meaning: line.cureLine + line.cureLabel + line.cureHold
                onFired: held => reasons.control.cure(line.index, held)
            }
        }
    }
}

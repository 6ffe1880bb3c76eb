// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// All that is known of the selected robots.
Rectangle {
    id: pane
    required property DetailList details
    property string title
    visible: details.open
    color: Theme.panel
    border.width: 1
    border.color: Theme.edge

    PlainLabel {
        id: heading
        x: 3 * Theme.mm
        width: parent.width - close.width - 6 * Theme.mm
        height: 11 * Theme.mm
        font.bold: true
        text: pane.title === "" ? "all robots" : pane.title
    }
    HoldButton {
        id: close
        objectName: "closeDetails"
        anchors.right: parent.right
        anchors.rightMargin: 1 * Theme.mm
        y: 1 * Theme.mm
        width: 9 * Theme.mm
        height: 9 * Theme.mm
        text: "×"
        spoken: "close the details"
        onFired: pane.details.open = false
    }
    PlainList {
        id: list
        objectName: "details"
        anchors.topMargin: heading.height
        anchors.leftMargin: 3 * Theme.mm
        anchors.bottomMargin: 0
        currentIndex: -1
        model: pane.visible ? pane.details.rows : null
        delegate: Item {
            id: row
            required property int index
            required property string label
            required property string value
            required property bool differs
            required property string actionLabel
            required property string actionLine
            required property bool actionHold
            width: list.width
            height: Math.max(text.implicitHeight + 2 * Theme.mm, action.visible ? 10.4 * Theme.mm : 0)
            PlainLabel {
                width: 23 * Theme.mm
                y: 1 * Theme.mm
                text: row.label
                color: Theme.dim
            }
            PlainLabel {
                id: text
                objectName: "detail_" + row.label
                x: 24 * Theme.mm
                y: 1 * Theme.mm
                width: (action.visible ? action.x - 2 * Theme.mm : parent.width) - x
                wrapMode: Text.Wrap
                maximumLineCount: 6
                text: row.value
                font.bold: row.differs
            }
            HoldButton {
                id: action
                objectName: "detailAction_" + row.label
                visible: row.actionLabel !== ""
                anchors.right: parent.right
                y: 0.7 * Theme.mm
                height: 9 * Theme.mm
                text: row.actionLabel
                hold: row.actionHold
                meaning: row.actionLine
                onFired: held => pane.details.act(row.index, held)
            }
        }
    }
}

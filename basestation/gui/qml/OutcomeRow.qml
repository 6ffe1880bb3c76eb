// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The last outcome, and how many actions are not possible now.
Rectangle {
    id: row
    required property Control control
    color: Theme.ground

    Rectangle {
        id: mark
        x: 3 * Theme.mm
        width: 1.6 * Theme.mm
        height: parent.height - 3 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
        color: row.control.outcomeKind === "done" ? Theme.ok : row.control.outcomeKind === "refused" ? Theme.bad : row.control.outcomeKind === "sent" ? Theme.goal : Theme.edge
    }
    FittedLabel {
        objectName: "outcome"
        anchors.left: mark.right
        anchors.leftMargin: 2 * Theme.mm
        anchors.right: buttons.left
        anchors.rightMargin: 2 * Theme.mm
        height: parent.height
        wrapMode: Text.Wrap
        maximumLineCount: 2
        brief: row.control.outcomeShort
        full: row.control.outcome === "" ? "No command yet. Tap a robot, then an action; press and hold on the map to send it there." : row.control.outcome
        color: row.control.outcome === "" ? Theme.dim : Theme.text
    }
    Row {
        id: buttons
        anchors.right: parent.right
        anchors.rightMargin: 2 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
        height: parent.height - 1 * Theme.mm
        spacing: 2 * Theme.mm
        HoldButton {
            objectName: "commandToggle"
            width: 28 * Theme.mm
            height: parent.height
            text: "command  :"
            onFired: row.control.commandLine.open = true
        }
        HoldButton {
            objectName: "detailsToggle"
            width: 24 * Theme.mm
            height: parent.height
            active: row.control.details.open
            text: "details  i"
            onFired: row.control.details.open = !row.control.details.open
        }
        HoldButton {
            objectName: "notNow"
            visible: row.control.refusalCount > 0
            width: 34 * Theme.mm
            height: parent.height
            text: "not now (" + row.control.refusalCount + ") " + (row.control.reasonsOpen ? "▾" : "▴")
            onFired: row.control.reasonsOpen = !row.control.reasonsOpen
        }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Notices of robots, and how commands ended: this window's and other programs'. The newest is on top.
Rectangle {
    id: tab
    required property Control control
    readonly property LogView log: control.tabs.log
    readonly property double side: 62 * Theme.mm
    color: Theme.panel

    PlainList {
        id: list
        objectName: "log"
        anchors.rightMargin: tab.side
        model: tab.log.lines
        onContentYChanged: tab.log.paused = contentY > originY + 2
        delegate: LogLine {
            width: list.width
        }
    }
    PlainLabel {
        visible: list.count === 0
        x: 3 * Theme.mm
        height: 8 * Theme.mm
        color: Theme.dim
        text: tab.log.text === "" && !tab.log.warnings && !tab.log.selected ? "log: nothing yet" : "log: no line that the filters let through"
    }
    HoldButton {
        objectName: "logWaiting"
        visible: tab.log.waiting > 0
        anchors.top: list.top
        anchors.right: list.right
        height: 10 * Theme.mm
        text: "▴ " + tab.log.waiting + " new"
        active: true
        onFired: list.positionViewAtBeginning()
    }
    Grid {
        x: parent.width - tab.side + 2 * Theme.mm
        y: 1.5 * Theme.mm
        columns: 2
        spacing: 1 * Theme.mm
        readonly property double place: (tab.side - 4.5 * Theme.mm) / 2
        readonly property double tall: (tab.height - 4 * Theme.mm) / 2
        HoldButton {
            objectName: "logWarnings"
            width: parent.place
            height: parent.tall
            active: tab.log.warnings
            text: "warnings"
            onFired: tab.log.warnings = !tab.log.warnings
        }
        HoldButton {
            objectName: "logSelected"
            width: parent.place
            height: parent.tall
            active: tab.log.selected
            text: "selected"
            onFired: tab.log.selected = !tab.log.selected
        }
        TextField {
            objectName: "logText"
            width: parent.place
            height: parent.tall
            hint: "filter: text"
            onEdited: text => tab.log.text = text
        }
        HoldButton {
            objectName: "logExport"
            width: parent.place
            height: parent.tall
            text: "export"
            onFired: tab.control.tabs.exportLog()
        }
    }
}

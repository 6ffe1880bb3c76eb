// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// What robots found: the most important first, with what the operator decided about it.
Item {
    id: tab
    required property Control control
    readonly property TabState state_: control.tabs

    PlainList {
        id: list
        objectName: "findings"
        anchors.bottomMargin: 15 * Theme.mm
        spacing: 1
        model: tab.state_.findings
        currentIndex: tab.state_.pickedRow
        highlightMoveDuration: 0
        delegate: FindingRow {
            width: list.width
            state_: tab.state_
        }
    }
    PlainLabel {
        visible: list.count === 0 || tab.state_.problem !== ""
        x: 3 * Theme.mm
        y: 2 * Theme.mm
        width: parent.width - 6 * Theme.mm
        height: 8 * Theme.mm
        color: tab.state_.problem === "" ? Theme.dim : Theme.text
        text: tab.state_.problem === "" ? "findings: nothing was found yet" : "findings: " + tab.state_.problem
    }
    Rectangle {
        width: parent.width
        height: 14 * Theme.mm
        y: parent.height - height
        color: Theme.ground
        PlainLabel {
            objectName: "missing"
            visible: tab.state_.noting === 0
            x: 3 * Theme.mm
            width: exporter.x - 5 * Theme.mm
            height: parent.height
            color: Theme.dim
            text: tab.state_.missing
        }
        Loader {
            active: tab.state_.noting !== 0
            x: 2 * Theme.mm
            y: 1 * Theme.mm
            width: exporter.x - 4 * Theme.mm
            height: 12 * Theme.mm
            sourceComponent: TextField {
                objectName: "note"
                first: true
                hint: "note on finding " + tab.state_.noting + ": Enter stores it, Esc takes it back"
                onEntered: text => tab.state_.endNote(text, true)
                onAbandoned: tab.state_.endNote("", false)
            }
        }
        HoldButton {
            id: exporter
            objectName: "findingsExport"
            x: parent.width - width - 2 * Theme.mm
            y: 0.5 * Theme.mm
            width: 40 * Theme.mm
            height: 13 * Theme.mm
            text: "export CSV, JSON"
            onFired: tab.state_.exportFindings()
        }
    }
}

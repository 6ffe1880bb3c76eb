// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The staircases that robots found, with who may climb them.
Item {
    id: tab
    required property Control control
    readonly property TabState state_: control.tabs
    component Head: PlainLabel {
        height: 6 * Theme.mm
        color: Theme.dim
    }

    Row {
        id: heads
        visible: list.count > 0
        x: 8.5 * Theme.mm
        y: 1 * Theme.mm
        Head { width: 16 * Theme.mm; text: "id, uphill" }
        Head { width: 36 * Theme.mm; text: "steps, floors" }
        Head { width: 44 * Theme.mm; text: "rise, run, width" }
        Head { width: (tab.width - 118 * Theme.mm) / 2; text: "seen by" }
        Head { width: (tab.width - 118 * Theme.mm) / 2; text: "who may climb" }
    }
    PlainList {
        id: list
        objectName: "stairs"
        anchors.topMargin: 7.5 * Theme.mm
        anchors.bottomMargin: 15 * Theme.mm
        spacing: 1
        model: tab.state_.stairs
        currentIndex: tab.state_.pickedStairsRow
        highlightMoveDuration: 0
        delegate: StairsRow {
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
        text: tab.state_.problem === "" ? "stairs: no staircase was found yet" : "stairs: " + tab.state_.problem
    }
    PlainLabel {
        objectName: "unreadable"
        x: 3 * Theme.mm
        y: parent.height - 7 * Theme.mm
        width: ways.x - 5 * Theme.mm
        height: 6 * Theme.mm
        color: Theme.dim
        text: tab.state_.unreadable !== "" ? tab.state_.unreadable : list.count === 0 ? "" : "Confirm or reject a staircase in Findings, by its id."
    }
    PlainLabel {
        objectName: "stairsOffer"
        visible: list.count > 0
        x: 3 * Theme.mm
        y: parent.height - 14 * Theme.mm
        width: ways.x - 5 * Theme.mm
        height: 6 * Theme.mm
        text: tab.control.stairsText
    }
    Row {
        id: ways
        visible: list.count > 0
        x: parent.width - width - 2 * Theme.mm
        y: parent.height - 13.5 * Theme.mm
        spacing: 2 * Theme.mm
        component Way: HoldButton {
            width: 30 * Theme.mm
            height: 13 * Theme.mm
            enabled: tab.control.stairsOffered
            opacity: enabled ? 1 : 0.4
            hold: tab.control.gotoHeld
            meaning: text + tab.control.stairsText
            spoken: text + ", " + tab.control.stairsText
        }
        Way { objectName: "goUp"; text: "go up"; onFired: held => tab.control.goOverStairs(true, held) }
        Way { objectName: "goDown"; text: "go down"; onFired: held => tab.control.goOverStairs(false, held) }
    }
}

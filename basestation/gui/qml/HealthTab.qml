// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Robots and their components: state, restarts, and what the operator may do about it.
Item {
    id: tab
    required property Control control
    readonly property TabState state_: control.tabs
    readonly property var chosen: state_.chosen

    Matrix {
        id: grid
        objectName: "health"
        x: 1.5 * Theme.mm
        y: 1 * Theme.mm
        width: parent.width - 3 * Theme.mm
        height: detail.y - y
        minimumPlace: 25 * Theme.mm
        corner: "robot"
        columns: tab.state_.columns
        columnCount: tab.state_.columnCount
        cells: tab.state_.cells
        cellHeight: 13 * Theme.mm
        delegate: HealthCell {
            width: grid.place - 1
            height: grid.cellHeight - 1
            onChosenByTap: tab.state_.choose(robot, component)
        }
    }
    PlainLabel {
        visible: grid.count === 0 || tab.state_.problem !== ""
        x: 3 * Theme.mm
        y: 2 * Theme.mm
        width: parent.width - 6 * Theme.mm
        height: 8 * Theme.mm
        color: tab.state_.problem === "" ? Theme.dim : Theme.text
        text: tab.state_.problem === "" ? "health: no robot has been heard" : "health: " + tab.state_.problem
    }
    Rectangle {
        id: detail
        width: parent.width
        height: 17 * Theme.mm
        y: parent.height - height
        color: Theme.ground
        PlainLabel {
            objectName: "healthTitle"
            x: 3 * Theme.mm
            y: 1 * Theme.mm
            width: policy.x - 5 * Theme.mm
            height: 5.5 * Theme.mm
            font.bold: true
            color: tab.chosen.title === "" ? Theme.dim : Theme.text
            text: tab.chosen.title === "" ? "tap a component to see why, and to restart it" : tab.chosen.title
        }
        PlainLabel {
            objectName: "healthText"
            x: 3 * Theme.mm
            y: 6.5 * Theme.mm
            width: policy.x - 5 * Theme.mm
            height: 10 * Theme.mm
            wrapMode: Text.Wrap
            maximumLineCount: 2
            text: tab.chosen.text
        }
        HoldButton {
            id: policy
            objectName: "healthPolicy"
            x: restart.x - width - 2 * Theme.mm
            y: 2 * Theme.mm
            width: 46 * Theme.mm
            height: 13 * Theme.mm
            opacity: tab.chosen.mine ? 1 : 0.35
            hold: tab.chosen.mine
            meaning: tab.chosen.title + text
            text: tab.chosen.title === "" ? "policy" : tab.chosen.automatic ? "auto → manual" : "manual → auto"
            onFired: held => held && tab.state_.changePolicy()
        }
        HoldButton {
            id: restart
            objectName: "healthRestart"
            x: parent.width - width - 2 * Theme.mm
            y: 2 * Theme.mm
            width: 36 * Theme.mm
            height: 13 * Theme.mm
            opacity: tab.chosen.mine ? 1 : 0.35
            hold: tab.chosen.mine
            meaning: tab.chosen.title
            text: "Restart"
            onFired: held => held && tab.state_.restartChosen()
        }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Robots and their components: state, restarts, and what the operator may do about it.
Item {
    id: tab
    required property Control control
    readonly property TabState state_: control.tabs
    readonly property int places: state_.columnCount + 1
    readonly property double place: Math.max(25 * Theme.mm, (width - 3 * Theme.mm) / places)

    Flickable {
        id: wide
        objectName: "health"
        x: 1.5 * Theme.mm
        y: 1 * Theme.mm
        width: parent.width - 3 * Theme.mm
        height: detail.y - y
        clip: true
        contentWidth: tab.place * tab.places
        contentHeight: height
        flickableDirection: Flickable.HorizontalFlick
        boundsBehavior: Flickable.StopAtBounds
        PlainLabel {
            width: tab.place
            height: 6 * Theme.mm
            leftPadding: 1 * Theme.mm
            color: Theme.dim
            text: "robot"
        }
        Repeater {
            model: tab.state_.columns
            PlainLabel {
                required property int index
                required property string name
                x: (index + 1) * tab.place
                width: tab.place
                height: 6 * Theme.mm
                leftPadding: 1 * Theme.mm
                color: Theme.dim
                text: name
            }
        }
        GridView {
            id: grid
            y: 6 * Theme.mm
            width: tab.place * tab.places + 0.5
            height: parent.height - y
            clip: true
            boundsBehavior: Flickable.StopAtBounds
            flickableDirection: Flickable.VerticalFlick
            cellWidth: tab.place
            cellHeight: 13 * Theme.mm
            model: tab.state_.cells
            delegate: HealthCell {
                width: grid.cellWidth - 1
                height: grid.cellHeight - 1
                onChosenByTap: tab.state_.choose(robot, component)
            }
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
            color: tab.state_.chosenTitle === "" ? Theme.dim : Theme.text
            text: tab.state_.chosenTitle === "" ? "tap a component to see why, and to restart it" : tab.state_.chosenTitle
        }
        PlainLabel {
            objectName: "healthText"
            x: 3 * Theme.mm
            y: 6.5 * Theme.mm
            width: policy.x - 5 * Theme.mm
            height: 10 * Theme.mm
            wrapMode: Text.Wrap
            maximumLineCount: 2
            text: tab.state_.chosenText
        }
        HoldButton {
            id: policy
            objectName: "healthPolicy"
            x: restart.x - width - 2 * Theme.mm
            y: 2 * Theme.mm
            width: 46 * Theme.mm
            height: 13 * Theme.mm
            opacity: tab.state_.chosenMine ? 1 : 0.35
            hold: tab.state_.chosenMine
            meaning: tab.state_.chosenTitle + text
            text: tab.state_.chosenTitle === "" ? "policy" : tab.state_.chosenAutomatic ? "auto → manual" : "manual → auto"
            onFired: held => held && tab.state_.changePolicy()
        }
        HoldButton {
            id: restart
            objectName: "healthRestart"
            x: parent.width - width - 2 * Theme.mm
            y: 2 * Theme.mm
            width: 36 * Theme.mm
            height: 13 * Theme.mm
            opacity: tab.state_.chosenMine ? 1 : 0.35
            hold: tab.state_.chosenMine
            meaning: tab.state_.chosenTitle
            text: "Restart"
            onFired: held => held && tab.state_.restartChosen()
        }
    }
}

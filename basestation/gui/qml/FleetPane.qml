// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: pane
    required property Control control
    color: Theme.ground

    PlainList {
        id: list
        objectName: "fleet"
        spacing: 1.5 * Theme.mm
        model: pane.control.robots
        delegate: RobotCard {
            control: pane.control
            width: list.width
        }
    }
    // How much of the list is above and below.
    Rectangle {
        visible: list.visibleArea.heightRatio < 1
        anchors.right: parent.right
        width: 0.8 * Theme.mm
        radius: width / 2
        y: list.y + list.visibleArea.yPosition * list.height
        height: Math.max(list.visibleArea.heightRatio * list.height, 4 * Theme.mm)
        color: Theme.edge
    }
    PlainLabel {
        visible: pane.control.robotCount === 0
        anchors.fill: parent
        anchors.margins: 4 * Theme.mm
        wrapMode: Text.WordWrap
        maximumLineCount: 8
        elide: Text.ElideNone
        color: Theme.dim
        text: "No robot has been heard yet. Robots appear by themselves when they are on this radio domain and in reach."
    }
}

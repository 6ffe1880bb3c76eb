// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The stick of the screen: up and down drives, left and right turns. It drives only while a finger is on it.
Rectangle {
    id: stick
    required property DriveControl drive
    width: 44 * Theme.mm
    height: width
    radius: width / 2
    color: Theme.panel
    opacity: 0.9
    border.width: 2
    border.color: area.held ? Theme.goal : Theme.edge

    Rectangle {
        width: 16 * Theme.mm
        height: width
        radius: width / 2
        x: (stick.width - width) / 2 - area.leftward * stick.width / 2
        y: (stick.height - height) / 2 - area.forward * stick.height / 2
        color: area.held ? Theme.goal : Theme.raised
        border.width: 1
        border.color: Theme.text
    }
    StickArea {
        id: area
        objectName: "touchStick"
        anchors.fill: parent
        Accessible.role: Accessible.Dial
        Accessible.name: "stick that drives the robot"
        onMoved: held ? stick.drive.touch(forward, leftward) : stick.drive.release()
        onReleased: stick.drive.release()
    }
}

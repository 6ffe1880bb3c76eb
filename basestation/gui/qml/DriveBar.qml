// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// In place of the action bar while a robot is driven by hand.
Rectangle {
    id: bar
    required property DriveControl drive
    color: Theme.panel

    PlainLabel {
        id: title
        objectName: "driveTitle"
        x: 3 * Theme.mm
        width: 44 * Theme.mm
        height: parent.height
        font.bold: true
        font.pixelSize: 4 * Theme.mm
        wrapMode: Text.Wrap
        maximumLineCount: 3
        color: bar.drive.good ? Theme.goal : Theme.bad
        text: "DRIVING " + bar.drive.robot
    }
    Column {
        anchors.left: title.right
        anchors.right: buttons.left
        anchors.verticalCenter: parent.verticalCenter
        spacing: 1 * Theme.mm
        PlainLabel {
            objectName: "driveAsked"
            width: parent.width
            text: "asked " + bar.drive.asked + "   ·   robot " + bar.drive.measured + "   ·   state " + bar.drive.age + " old"
        }
        PlainLabel {
            objectName: "driveWhy"
            width: parent.width
            color: bar.drive.why === "" ? Theme.dim : Theme.warn
            text: bar.drive.why !== "" ? bar.drive.why : bar.drive.held ? "dead man's switch held" : "hold the stick, an arrow key, or the controller's left shoulder button"
        }
    }
    Row {
        id: buttons
        anchors.right: parent.right
        anchors.rightMargin: 2 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
        height: 12 * Theme.mm
        spacing: 2 * Theme.mm
        HoldButton {
            objectName: "driveStop"
            height: parent.height
            width: 34 * Theme.mm
            color: Theme.bad
            text: "STOP " + bar.drive.robot + "  X"
            spoken: "software stop of " + bar.drive.robot
            onFired: bar.drive.stopRobot()
        }
        HoldButton {
            objectName: "driveSmart"
            height: parent.height
            active: bar.drive.mode === "smart_joystick"
            text: "smart"
            onFired: bar.drive.setMode("smart_joystick")
        }
        HoldButton {
            objectName: "driveManual"
            height: parent.height
            active: bar.drive.mode === "manual"
            text: "manual"
            onFired: bar.drive.setMode("manual")
        }
        HoldButton {
            objectName: "letGo"
            height: parent.height
            width: 34 * Theme.mm
            text: "let go  Esc"
            onFired: bar.drive.letGo()
        }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The picture of the robot that is driven by hand, beside its map.
Rectangle {
    id: pane
    required property DriveControl drive
    required property CameraFeeds feeds
    height: width * 0.75
    color: "#141414"
    border.width: 1 * Theme.mm
    border.color: drive.good && !picture.stale ? Theme.goal : Theme.bad

    CameraView {
        id: picture
        name: "driveCamera"
        anchors.fill: parent
        anchors.margins: pane.border.width
        lineBelow: true
        feeds: pane.feeds
        robot: pane.drive.driving ? pane.drive.robot : ""
        camera: pane.drive.camera
    }
}

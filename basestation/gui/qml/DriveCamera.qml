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

    CameraItem {
        id: picture
        objectName: "driveCamera"
        anchors.fill: parent
        anchors.margins: pane.border.width
        visible: pane.visible
        feeds: pane.feeds
        robot: pane.drive.driving ? pane.drive.robot : ""
        camera: pane.drive.camera
    }
    Rectangle {
        anchors.fill: caption
        color: "#b0141414"
    }
    PlainLabel {
        id: caption
        objectName: "driveCameraCaption"
        anchors.bottom: picture.bottom
        x: pane.border.width
        width: picture.width
        height: 5.5 * Theme.mm
        leftPadding: 1 * Theme.mm
        color: picture.stale ? "#ffd27a" : "white"
        text: picture.caption
    }
}

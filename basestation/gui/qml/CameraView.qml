// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The live picture of a camera, with a line over it that says how old it is.
Item {
    id: view
    required property CameraFeeds feeds
    property string robot
    property string camera
    property bool lineBelow: false
    property string name
    readonly property bool stale: picture.stale

    CameraItem {
        id: picture
        objectName: view.name
        anchors.fill: parent
        feeds: view.feeds
        robot: view.robot
        camera: view.camera
    }
    Rectangle {
        width: parent.width
        height: 5.5 * Theme.mm
        y: view.lineBelow ? parent.height - height : 0
        color: "#b0141414"
        PlainLabel {
            objectName: view.name + "Caption"
            anchors.fill: parent
            anchors.leftMargin: 1 * Theme.mm
            color: picture.stale ? "#ffd27a" : "white"
            text: picture.caption
        }
    }
}

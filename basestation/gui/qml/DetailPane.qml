// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// All that is known of the selected robots.
Rectangle {
    id: pane
    required property DetailList details
    required property CameraFeeds feeds
    readonly property bool hasCamera: details.cameraRobot !== ""
    property string title
    visible: details.open
    color: Theme.panel
    border.width: 1
    border.color: Theme.edge

    PlainLabel {
        id: heading
        x: 3 * Theme.mm
        width: parent.width - close.width - 6 * Theme.mm
        height: 11 * Theme.mm
        font.bold: true
        text: pane.title === "" ? "all robots" : pane.title
    }
    HoldButton {
        id: close
        objectName: "closeDetails"
        anchors.right: parent.right
        anchors.rightMargin: 1 * Theme.mm
        y: 1 * Theme.mm
        width: 9 * Theme.mm
        height: 9 * Theme.mm
        text: "×"
        spoken: "close the details"
        onFired: pane.details.open = false
    }
    Item {
        id: cameraArea
        anchors.top: heading.bottom
        x: 3 * Theme.mm
        width: parent.width - 6 * Theme.mm
        height: !pane.hasCamera ? 0 : pane.details.cameraOn ? width * 0.75 + 11 * Theme.mm : 11 * Theme.mm
        visible: pane.hasCamera
        CameraView {
            name: "detailCamera"
            visible: pane.visible && pane.hasCamera && pane.details.cameraOn
            width: parent.width
            height: width * 0.75
            feeds: pane.feeds
            robot: pane.details.cameraRobot
            camera: pane.details.camera
        }
        PlainLabel {
            anchors.left: parent.left
            anchors.right: cameraSwitch.left
            anchors.bottom: parent.bottom
            height: 10 * Theme.mm
            color: Theme.dim
            text: pane.details.cameraOn ? pane.details.cameraText : pane.details.cameraNames
        }
        HoldButton {
            id: cameraNext
            objectName: "nextCamera"
            visible: pane.details.cameraOn && pane.details.cameras.length > 1
            anchors.right: cameraSwitch.left
            anchors.rightMargin: 1 * Theme.mm
            anchors.bottom: parent.bottom
            anchors.bottomMargin: 1 * Theme.mm
            width: 14 * Theme.mm
            height: 9 * Theme.mm
            text: "next"
            spoken: "show the next camera"
            onFired: pane.details.next_camera()
        }
        HoldButton {
            id: cameraSwitch
            objectName: "cameraSwitch"
            anchors.right: parent.right
            anchors.bottom: parent.bottom
            anchors.bottomMargin: 1 * Theme.mm
            width: 26 * Theme.mm
            height: 9 * Theme.mm
            text: pane.details.cameraOn ? "camera off" : "camera on"
            onFired: pane.details.cameraOn = !pane.details.cameraOn
        }
    }
    PlainList {
        id: list
        objectName: "details"
        anchors.topMargin: heading.height + cameraArea.height
        anchors.leftMargin: 3 * Theme.mm
        anchors.bottomMargin: 0
        currentIndex: -1
        model: pane.visible ? pane.details.rows : null
        delegate: Item {
            id: row
            required property int index
            required property string label
            required property string value
            required property bool differs
            required property string actionLabel
            required property string actionLine
            required property bool actionHold
            width: list.width
            height: Math.max(text.implicitHeight + 2 * Theme.mm, action.visible ? 10.4 * Theme.mm : 0)
            PlainLabel {
                width: 23 * Theme.mm
                y: 1 * Theme.mm
                text: row.label
                color: Theme.dim
            }
            PlainLabel {
                id: text
                objectName: "detail_" + row.label
                x: 24 * Theme.mm
                y: 1 * Theme.mm
                width: (action.visible ? action.x - 2 * Theme.mm : parent.width) - x
                wrapMode: Text.Wrap
                maximumLineCount: 6
                text: row.value
                font.bold: row.differs
            }
            HoldButton {
                id: action
                objectName: "detailAction_" + row.label
                visible: row.actionLabel !== ""
                anchors.right: parent.right
                y: 0.7 * Theme.mm
                height: 9 * Theme.mm
                text: row.actionLabel
                hold: row.actionHold
                meaning: row.actionLine
                onFired: held => pane.details.act(row.index, held)
            }
        }
    }
}

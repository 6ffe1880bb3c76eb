// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The window for a second screen: the map, and all cameras beside it. It only shows; but it stops all robots.
Window {
    id: window
    required property Control control
    width: 1280
    height: 720
    minimumWidth: 800
    minimumHeight: 500
    color: Theme.ground
    title: "Adit " + control.operatorName + ": map"
    onActiveChanged: control.setFocused(active)

    FocusScope {
        anchors.fill: parent
        focus: true
        Keys.onPressed: event => event.accepted = window.control.pressKey(event.key, event.modifiers, event.nativeScanCode, event.isAutoRepeat)
        Keys.onReleased: event => event.accepted = window.control.releaseKey(event.key, event.nativeScanCode, event.isAutoRepeat)

        TopBar {
            id: top
            control: window.control
            width: parent.width - stop.width - 4 * Theme.mm
            height: 12 * Theme.mm
        }
        MapPane {
            control: window.control
            anchors.left: parent.left
            anchors.right: side.left
            anchors.top: top.bottom
            anchors.bottom: parent.bottom
        }
        Rectangle {
            id: side
            color: Theme.panel
            // Three columns of thumbnails.
            width: Math.min(Math.max(116 * Theme.mm, 0.28 * parent.width), 0.5 * parent.width)
            anchors.right: parent.right
            anchors.top: top.bottom
            anchors.bottom: parent.bottom
            CameraWall {
                control: window.control
                anchors.fill: parent
                anchors.topMargin: stop.y + stop.height - top.height
                anchors.bottomMargin: outcome.height
            }
            FittedLabel {
                id: outcome
                objectName: "outcome"
                x: 1.5 * Theme.mm
                y: parent.height - height
                width: parent.width - 3 * Theme.mm
                height: full === "" ? 0 : 9 * Theme.mm
                wrapMode: Text.Wrap
                maximumLineCount: 2
                full: window.control.outcome
                brief: window.control.outcomeShort
            }
        }
        StopAll {
            id: stop
            control: window.control
            x: parent.width - width - 2 * Theme.mm
            y: 1 * Theme.mm
        }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Window {
    id: window
    required property Control control
    readonly property double stopWidth: stop.width + 4 * Theme.mm
    width: 1280
    height: 720
    minimumWidth: 800
    minimumHeight: 500
    color: Theme.ground
    title: "Adit " + control.operatorName
    onActiveChanged: control.setFocused(active)
    onActiveFocusItemChanged: control.forgetKeys()

    FocusScope {
        anchors.fill: parent
        focus: true
        Keys.onPressed: event => event.accepted = window.control.pressKey(event.key, event.modifiers, event.nativeScanCode, event.isAutoRepeat)
        Keys.onReleased: event => event.accepted = window.control.releaseKey(event.key, event.nativeScanCode, event.isAutoRepeat)

        TopBar {
            id: top
            control: window.control
            width: parent.width - window.stopWidth
            height: 12 * Theme.mm
        }
        AttentionStrip {
            id: attention
            attention: window.control.attention
            width: top.width
            anchors.top: top.bottom
            height: 12 * Theme.mm
        }
        StopAll {
            id: stop
            control: window.control
            x: parent.width - width - 2 * Theme.mm
            y: 1 * Theme.mm
        }
        FleetPane {
            id: fleet
            control: window.control
            width: 74 * Theme.mm
            anchors.top: attention.bottom
            anchors.bottom: actions.top
        }
        MapPane {
            id: map
            control: window.control
            covered: panel.open === "" ? 0 : panel.height - panel.strip
            coveredRight: picture.visible ? picture.width + 2 * Theme.mm : 0
            anchors.left: fleet.right
            anchors.right: details.visible ? details.left : parent.right
            anchors.top: attention.bottom
            anchors.bottom: actions.top
            anchors.bottomMargin: window.control.tabs.open === "" ? 0 : panel.strip
        }
        DetailPane {
            id: details
            details: window.control.details
            feeds: window.control.feeds
            title: window.control.selectionText
            anchors.right: parent.right
            anchors.top: attention.bottom
            anchors.bottom: actions.top
            anchors.bottomMargin: window.control.tabs.open === "" ? 0 : panel.strip
            width: 84 * Theme.mm
        }
        TabPanel {
            id: panel
            control: window.control
            space: actions.y - map.y
            x: parent.width < 220 * Theme.mm ? 0 : fleet.width
            width: parent.width - x
            anchors.bottom: actions.top
        }
        PhotoPane {
            photos: window.control.tabs.photos
            visible: window.control.tabs.photos.open
            width: parent.width
            anchors.top: attention.bottom
            anchors.bottom: actions.top
        }
        AttentionMenu {
            attention: window.control.attention
            anchors.left: fleet.right
            anchors.right: parent.right
            anchors.top: attention.bottom
        }
        ReasonList {
            control: window.control
            anchors.left: fleet.right
            anchors.right: parent.right
            anchors.bottom: actions.top
        }
        ActionBar {
            id: actions
            control: window.control
            width: parent.width
            height: 16 * Theme.mm
            anchors.bottom: outcome.top
        }
        DriveCamera {
            id: picture
            drive: window.control.drive
            feeds: window.control.feeds
            visible: window.control.drive.driving && window.control.drive.camera !== ""
            anchors.top: map.top
            anchors.right: map.right
            anchors.margins: 2 * Theme.mm
            width: Math.min(map.width * 0.55, (map.height - 4 * Theme.mm) * 4 / 3)
        }
        DriveBar {
            drive: window.control.drive
            visible: window.control.drive.driving
            anchors.fill: actions
        }
        TouchStick {
            drive: window.control.drive
            visible: window.control.drive.driving
            anchors.left: fleet.right
            anchors.leftMargin: 3 * Theme.mm
            anchors.bottom: map.bottom
            anchors.bottomMargin: 3 * Theme.mm
        }
        OutcomeRow {
            id: outcome
            control: window.control
            width: parent.width
            height: 9 * Theme.mm
            anchors.bottom: tabs.top
        }
        CommandPanel {
            line: window.control.commandLine
            control: window.control
            anchors.left: fleet.right
            anchors.right: parent.right
            anchors.bottom: outcome.bottom
        }
        Tabs {
            id: tabs
            control: window.control
            width: parent.width
            height: 13 * Theme.mm
            anchors.bottom: parent.bottom
        }
        Rectangle {
            objectName: "driveFrame"
            visible: window.control.drive.driving
            anchors.fill: parent
            color: "transparent"
            border.width: 1.4 * Theme.mm
            border.color: window.control.drive.good ? Theme.goal : Theme.bad
        }
    }
}

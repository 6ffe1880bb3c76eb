// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// What the open tab shows, above the action bar. The log takes a strip of the map, that of cameras all of it; the
// others cover most of it.
Rectangle {
    id: panel
    required property Control control
    required property double space
    readonly property string open: control.tabs.open
    readonly property double strip: 24 * Theme.mm
    readonly property double tall: Math.min(Math.max(0.62 * space, 66 * Theme.mm), space)
    objectName: "panel"
    visible: open !== ""
    height: open === "log" ? strip : open === "cameras" ? space : tall
    color: Theme.panel

    // Neither a finger nor the mouse on the panel reaches the map below it.
    MouseArea {
        anchors.fill: parent
        acceptedButtons: Qt.AllButtons
        onWheel: wheel => wheel.accepted = true
    }
    LogTab {
        control: panel.control
        anchors.fill: parent
        visible: panel.open === "log"
    }
    Component { id: findings; FindingsTab { control: panel.control } }
    Component { id: health; HealthTab { control: panel.control } }
    Component { id: network; NetworkTab { control: panel.control } }
    Component { id: stairs; StairsTab { control: panel.control } }
    Component { id: cameras; CameraWall { control: panel.control } }
    Component { id: settings; SettingsTab { control: panel.control } }
    Loader {
        anchors.fill: parent
        sourceComponent: ({ findings: findings, health: health, network: network, stairs: stairs, cameras: cameras, settings: settings })[panel.open] ?? null
    }
    Rectangle {
        width: parent.width
        height: 1
        color: Theme.edge
    }
}

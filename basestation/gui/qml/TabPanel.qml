// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// What the open tab shows, above the action bar. The log takes a strip of the map; the others cover more of it.
Rectangle {
    id: panel
    required property Control control
    required property double space
    readonly property string open: control.tabs.open
    readonly property double strip: 24 * Theme.mm
    readonly property double tall: Math.min(Math.max(0.62 * space, 66 * Theme.mm), space)
    objectName: "panel"
    visible: open !== ""
    height: open === "log" ? strip : tall
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
    Loader {
        anchors.fill: parent
        active: panel.open === "findings"
        sourceComponent: FindingsTab {
            control: panel.control
        }
    }
    Loader {
        anchors.fill: parent
        active: panel.open === "health"
        sourceComponent: HealthTab {
            control: panel.control
        }
    }
    Loader {
        anchors.fill: parent
        active: panel.open === "network"
        sourceComponent: NetworkTab {
            control: panel.control
        }
    }
    Loader {
        anchors.fill: parent
        active: panel.open === "settings"
        sourceComponent: SettingsTab {
            control: panel.control
        }
    }
    Rectangle {
        width: parent.width
        height: 1
        color: Theme.edge
    }
}

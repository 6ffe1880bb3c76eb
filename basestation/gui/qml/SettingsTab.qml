// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Settings of the window. Each change acts at once.
Item {
    id: tab
    required property Control control
    readonly property WindowSettings settings: control.tabs.settings
    component Button: HoldButton {
        width: 30 * Theme.mm
        height: 13 * Theme.mm
    }

    Flickable {
        objectName: "settings"
        anchors.fill: parent
        anchors.margins: 3 * Theme.mm
        clip: true
        boundsBehavior: Flickable.StopAtBounds
        contentHeight: rows.height
        Column {
            id: rows
            width: parent.width
            spacing: 2 * Theme.mm
            SettingRow {
                width: parent.width
                title: "Glove mode"
                text: "targets of 20 mm, and 0.8 s for a long press on the map"
                Button {
                    objectName: "glove"
                    active: Theme.glove
                    text: Theme.glove ? "on" : "off"
                    onFired: Theme.glove = !Theme.glove
                }
            }
            SettingRow {
                width: parent.width
                title: "Size"
                text: "the line is 50 mm long where it is right; screens state their size wrongly"
                Button {
                    objectName: "smaller"
                    width: height
                    text: "−"
                    spoken: "smaller"
                    onFired: tab.settings.scale -= 0.05
                }
                PlainLabel {
                    objectName: "scale"
                    width: 16 * Theme.mm
                    height: 13 * Theme.mm
                    horizontalAlignment: Text.AlignHCenter
                    text: Math.round(tab.settings.scale * 100) + " %"
                }
                Button {
                    objectName: "larger"
                    width: height
                    text: "+"
                    spoken: "larger"
                    onFired: tab.settings.scale += 0.05
                }
            }
            Rectangle {
                x: 1 * Theme.mm
                width: 50 * Theme.mm / (Theme.glove ? 20 / 13 : 1)
                height: 1 * Theme.mm
                color: Theme.goal
            }
            SettingRow {
                width: parent.width
                title: "Theme"
                text: "light for sunlight; also Ctrl+L"
                Button {
                    objectName: "theme"
                    text: Theme.light ? "light" : "dark"
                    onFired: Theme.light = !Theme.light
                }
            }
            SettingRow {
                width: parent.width
                title: "Defaults"
                text: tab.settings.file === "" ? "changes are not stored" : "stored in " + tab.settings.file
                Button {
                    objectName: "restore"
                    opacity: tab.settings.isDefault ? 0.35 : 1
                    text: "restore"
                    onFired: tab.settings.restoreDefaults()
                }
            }
        }
    }
}

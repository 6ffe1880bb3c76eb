// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Settings of the window. Each change acts at once.
Item {
    id: tab
    required property Control control
    readonly property WindowSettings settings: control.tabs.settings

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
                HoldButton {
                    objectName: "glove"
                    width: 30 * Theme.mm
                    height: 13 * Theme.mm
                    active: tab.settings.glove
                    text: tab.settings.glove ? "on" : "off"
                    onFired: tab.settings.glove = !tab.settings.glove
                }
            }
            SettingRow {
                width: parent.width
                title: "Size"
                text: "the line is 50 mm long where it is right; screens state their size wrongly"
                HoldButton {
                    objectName: "smaller"
                    width: 13 * Theme.mm
                    height: 13 * Theme.mm
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
                HoldButton {
                    objectName: "larger"
                    width: 13 * Theme.mm
                    height: 13 * Theme.mm
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
                HoldButton {
                    objectName: "theme"
                    width: 30 * Theme.mm
                    height: 13 * Theme.mm
                    text: tab.settings.light ? "light" : "dark"
                    onFired: tab.settings.light = !tab.settings.light
                }
            }
            SettingRow {
                width: parent.width
                title: "Defaults"
                text: tab.settings.file === "" ? "changes are not stored" : "stored in " + tab.settings.file
                HoldButton {
                    objectName: "restore"
                    width: 30 * Theme.mm
                    height: 13 * Theme.mm
                    opacity: tab.settings.isDefault ? 0.35 : 1
                    text: "restore"
                    onFired: tab.settings.restoreDefaults()
                }
            }
        }
    }
}

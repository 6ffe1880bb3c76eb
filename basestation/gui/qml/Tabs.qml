// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The row of tabs at the bottom of the window. It never moves.
Rectangle {
    id: row
    required property Control control
    color: Theme.ground

    Repeater {
        id: list
        model: row.control.tabs.tabs
        Rectangle {
            id: tab_
            required property int index
            required property string tab
            required property string label
            required property string key
            required property string count
            required property bool alarm
            readonly property bool open: tab === row.control.tabs.open
            readonly property bool roomy: width > 40 * Theme.mm
            x: index * width
            width: row.width / Math.max(1, list.count)
            height: row.height
            color: area.pressed ? Theme.edge : open ? Theme.panel : Theme.ground
            Rectangle {
                visible: tab_.open
                width: parent.width
                height: 0.8 * Theme.mm
                color: Theme.goal
            }
            Rectangle {
                x: parent.width - 1
                width: 1
                height: parent.height
                color: Theme.edge
            }
            Row {
                anchors.centerIn: parent
                spacing: 1.5 * Theme.mm
                PlainLabel {
                    height: 6 * Theme.mm
                    width: Math.min(implicitWidth, tab_.width - (tab_.roomy ? 22 : tab_.count === "" ? 2 : 15) * Theme.mm)
                    font.bold: tab_.open
                    text: tab_.label
                }
                PlainLabel {
                    objectName: "count_" + tab_.tab
                    visible: text !== "" && !tab_.alarm
                    height: 6 * Theme.mm
                    font.bold: true
                    text: tab_.count
                }
                Chip {
                    width: 12 * Theme.mm
                    visible: tab_.alarm
                    anchors.verticalCenter: parent.verticalCenter
                    text: tab_.count
                    shape: "square"
                    fill: Theme.bad
                }
                PlainLabel {
                    height: 6 * Theme.mm
                    visible: tab_.roomy
                    color: Theme.dim
                    text: tab_.key
                }
            }
            PressArea {
                id: area
                objectName: "tab_" + tab_.tab
                anchors.fill: parent
                Accessible.role: Accessible.PageTab
                Accessible.name: tab_.label
                Accessible.onPressAction: row.control.tabs.toggle(tab_.tab)
                onTapped: row.control.tabs.toggle(tab_.tab)
            }
        }
    }
}

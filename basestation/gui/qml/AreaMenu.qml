// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// What a rectangle means that was drawn on the map.
Rectangle {
    id: menu
    required property AreaTool area
    visible: area.ready
    width: row.width + 6 * Theme.mm
    height: 14 * Theme.mm
    radius: 1 * Theme.mm
    color: Theme.panel
    border.width: 1
    border.color: Theme.goal

    Row {
        id: row
        anchors.centerIn: parent
        height: 10 * Theme.mm
        spacing: 2 * Theme.mm
        PlainLabel {
            objectName: "areaText"
            height: parent.height
            width: Math.min(implicitWidth, 60 * Theme.mm)
            text: menu.area.text
        }
        HoldButton { objectName: "area_keep_out"; height: parent.height; text: "keep out"; hold: menu.area.held; meaning: menu.area.text; onFired: held => menu.area.apply("keep_out", held) }
        HoldButton { objectName: "area_keep_in"; height: parent.height; text: "keep in"; hold: menu.area.held; meaning: menu.area.text; onFired: held => menu.area.apply("keep_in", held) }
        HoldButton { objectName: "area_prefer"; height: parent.height; text: "explore first"; hold: menu.area.held; meaning: menu.area.text; onFired: held => menu.area.apply("prefer", held) }
        HoldButton { objectName: "area_cancel"; width: 10 * Theme.mm; height: parent.height; text: "×"; spoken: "no area"; onFired: menu.area.active = false }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// What is at a place that was chosen on the map: a text, then the kind, which sends it.
Rectangle {
    id: menu
    required property MarkTool mark
    visible: mark.ready
    width: box.width + 6 * Theme.mm
    height: box.height + 4 * Theme.mm
    radius: 1 * Theme.mm
    color: Theme.panel
    border.width: 1
    border.color: Theme.goal
    onVisibleChanged: field.text = ""

    Column {
        id: box
        anchors.centerIn: parent
        spacing: 2 * Theme.mm
        Row {
            height: 12 * Theme.mm
            spacing: 2 * Theme.mm
            PlainLabel {
                objectName: "markPlace"
                width: 40 * Theme.mm
                height: parent.height
                text: menu.mark.place
            }
            TextField {
                id: field
                objectName: "markText"
                width: 50 * Theme.mm
                height: parent.height
                hint: "text, if any; then the kind"
                onAbandoned: menu.mark.drop()
            }
            HoldButton { objectName: "mark_cancel"; width: 12 * Theme.mm; height: parent.height; text: "×"; spoken: "no mark"; onFired: menu.mark.drop() }
        }
        Grid {
            columns: 4
            spacing: 2 * Theme.mm
            Repeater {
                model: menu.mark.kinds
                HoldButton {
                    required property string modelData
                    objectName: "mark_" + modelData
                    width: 24 * Theme.mm
                    height: 12 * Theme.mm
                    text: modelData
                    meaning: menu.mark.place
                    onFired: menu.mark.apply(modelData, field.text)
                }
            }
        }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Who hears whom: a row for each hearer, a column for each speaker.
Flickable {
    id: wide
    required property TabState state_
    readonly property int places: state_.speakerCount + 1
    readonly property double place: Math.max(24 * Theme.mm, width / places)
    objectName: "hearing"
    clip: true
    contentWidth: place * places
    contentHeight: height
    flickableDirection: Flickable.HorizontalFlick
    boundsBehavior: Flickable.StopAtBounds

    PlainLabel {
        width: wide.place
        height: 6 * Theme.mm
        leftPadding: 1 * Theme.mm
        color: Theme.dim
        text: "↓ hears →"
    }
    Repeater {
        model: wide.state_.speakers
        PlainLabel {
            required property int index
            required property string name
            x: (index + 1) * wide.place
            width: wide.place
            height: 6 * Theme.mm
            leftPadding: 1 * Theme.mm
            font.bold: true
            text: name
        }
    }
    GridView {
        y: 6 * Theme.mm
        width: wide.place * wide.places + 0.5
        height: parent.height - y
        clip: true
        boundsBehavior: Flickable.StopAtBounds
        flickableDirection: Flickable.VerticalFlick
        cellWidth: wide.place
        cellHeight: 8 * Theme.mm
        model: wide.state_.hearing
        delegate: Rectangle {
            id: cell
            required property string name
            required property string label
            required property string shape
            required property string token
            width: wide.place - 1
            height: 8 * Theme.mm - 1
            color: shape === "" ? "transparent" : Theme.raised
            Glyph {
                visible: cell.shape !== ""
                x: 1 * Theme.mm
                anchors.verticalCenter: parent.verticalCenter
                width: 3.6 * Theme.mm
                height: width
                kind: cell.shape
                colour: cell.token === "ok" ? Theme.ok : cell.token === "warn" ? Theme.warn : Theme.bad
                outline: Theme.ink
            }
            PlainLabel {
                x: (cell.shape === "" ? 1 : 5.6) * Theme.mm
                width: parent.width - x
                height: parent.height
                font.bold: cell.name !== ""
                text: cell.label
            }
        }
    }
}

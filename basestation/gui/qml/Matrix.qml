// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A table of robots: a name above each column, and cells row by row, which scroll by themselves.
Flickable {
    id: wide
    required property var columns
    required property int columnCount
    required property double minimumPlace
    property string corner
    property bool bold: false
    property alias cells: grid.model
    property alias cellHeight: grid.cellHeight
    property alias delegate: grid.delegate
    property alias count: grid.count
    readonly property int places: columnCount + 1
    readonly property double place: Math.max(minimumPlace, width / places)
    component Heading: PlainLabel {
        height: 6 * Theme.mm
        leftPadding: 1 * Theme.mm
        color: Theme.dim
    }
    clip: true
    contentWidth: place * places
    contentHeight: height
    flickableDirection: Flickable.HorizontalFlick
    boundsBehavior: Flickable.StopAtBounds

    Heading { width: wide.place; text: wide.corner }
    Repeater {
        model: wide.columns
        Heading {
            required property int index
            required property string name
            x: (index + 1) * wide.place
            width: wide.place
            font.bold: wide.bold
            color: wide.bold ? Theme.text : Theme.dim
            text: name
        }
    }
    GridView {
        id: grid
        y: 6 * Theme.mm
        width: wide.place * wide.places + 0.5
        height: parent.height - y
        clip: true
        boundsBehavior: Flickable.StopAtBounds
        flickableDirection: Flickable.VerticalFlick
        cellWidth: wide.place
    }
}

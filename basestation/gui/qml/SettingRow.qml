// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Item {
    id: row
    property string title
    property string text
    default property alias buttons: place.data
    height: 13 * Theme.mm

    PlainLabel {
        width: place.x - 2 * Theme.mm
        height: 6.5 * Theme.mm
        font.bold: true
        text: row.title
    }
    PlainLabel {
        y: 6.5 * Theme.mm
        width: place.x - 2 * Theme.mm
        height: 6.5 * Theme.mm
        color: Theme.dim
        text: row.text
    }
    Row {
        id: place
        x: parent.width - width
        spacing: 2 * Theme.mm
    }
}

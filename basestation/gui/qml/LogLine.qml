// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Item {
    id: row
    required property string time
    required property string kind
    required property string who
    required property string line
    height: 5.2 * Theme.mm

    PlainLabel {
        width: 16 * Theme.mm
        height: parent.height
        text: row.time
        color: Theme.dim
    }
    Glyph {
        x: 17 * Theme.mm
        width: 3.4 * Theme.mm
        height: width
        anchors.verticalCenter: parent.verticalCenter
        visible: row.kind === "ok" || row.kind === "warn" || row.kind === "bad"
        kind: row.kind === "ok" ? "disc" : row.kind === "warn" ? "triangle" : "square"
        colour: row.kind === "ok" ? Theme.ok : row.kind === "warn" ? Theme.warn : Theme.bad
        outline: Theme.ink
    }
    PlainLabel {
        x: 22 * Theme.mm
        width: 30 * Theme.mm
        height: parent.height
        text: row.who
        color: Theme.dim
    }
    PlainLabel {
        x: 53 * Theme.mm
        width: parent.width - x
        height: parent.height
        text: row.line
        color: row.kind === "dim" ? Theme.dim : Theme.text
    }
}

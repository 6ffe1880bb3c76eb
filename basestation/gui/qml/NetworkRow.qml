// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: row
    required property string agent
    required property string loss
    required property string trip
    required property string rates
    required property string queue
    required property string budget
    required property double share
    required property string dropped
    required property string shape
    required property string token
    readonly property double third: (width - 34 * Theme.mm) / 2
    height: 13 * Theme.mm
    color: Theme.raised

    Glyph {
        x: 1.5 * Theme.mm
        y: 2 * Theme.mm
        width: 4 * Theme.mm
        height: width
        kind: row.shape
        colour: row.token === "ok" ? Theme.ok : row.token === "warn" ? Theme.warn : row.token === "bad" ? Theme.bad : Theme.text
        outline: Theme.ink
    }
    PlainLabel {
        x: 7 * Theme.mm
        y: 1 * Theme.mm
        width: 26 * Theme.mm
        height: parent.height - 2 * Theme.mm
        wrapMode: Text.Wrap
        maximumLineCount: 2
        font.bold: true
        text: row.agent
    }
    PlainLabel {
        x: 34 * Theme.mm
        y: 1 * Theme.mm
        width: row.third - 2 * Theme.mm
        height: 5.4 * Theme.mm
        text: row.loss
    }
    PlainLabel {
        x: 34 * Theme.mm
        y: 6.6 * Theme.mm
        width: row.third - 2 * Theme.mm
        height: 5.4 * Theme.mm
        color: Theme.dim
        text: row.trip + (row.rates === "" ? "" : "  ·  " + row.rates)
    }
    Rectangle {
        x: 34 * Theme.mm + row.third
        y: 1 * Theme.mm
        width: row.third - 1.5 * Theme.mm
        height: 5.4 * Theme.mm
        color: "transparent"
        border.width: row.share < 0 ? 0 : 1
        border.color: Theme.edge
        Rectangle {
            visible: row.share >= 0
            width: parent.width * Math.max(0, row.share)
            height: parent.height
            color: row.share > 0.9 ? Theme.warn : Theme.edge
        }
        PlainLabel {
            objectName: "budget"
            anchors.fill: parent
            leftPadding: row.share < 0 ? 0 : 1 * Theme.mm
            color: row.share > 0.9 ? Theme.ink : Theme.text
            text: row.budget
        }
    }
    PlainLabel {
        x: 34 * Theme.mm + row.third
        y: 6.6 * Theme.mm
        width: row.third - 1.5 * Theme.mm
        height: 5.4 * Theme.mm
        color: Theme.dim
        text: row.queue + (row.dropped === "" ? "" : (row.queue === "" ? "" : "  ·  ") + row.dropped)
    }
}

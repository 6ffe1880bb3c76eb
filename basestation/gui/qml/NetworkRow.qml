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
    required property var parts
    readonly property double third: (width - 34 * Theme.mm) / 2
    height: 13 * Theme.mm
    color: Theme.raised
    component Words: PlainLabel {
        height: 5.4 * Theme.mm
    }

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
    Words {
        x: 34 * Theme.mm
        y: 1 * Theme.mm
        width: row.third - 2 * Theme.mm
        text: row.loss
    }
    Words {
        x: 34 * Theme.mm
        y: 6.6 * Theme.mm
        width: row.third - 2 * Theme.mm
        color: Theme.dim
        text: row.trip + (row.rates === "" ? "" : "  ·  " + row.rates)
    }
    Words {
        objectName: "budget"
        x: 34 * Theme.mm + row.third
        y: 1 * Theme.mm
        width: row.third - 1.5 * Theme.mm
        text: row.budget + (row.dropped === "" ? "" : "  ·  " + row.dropped)
    }
    Rectangle {
        id: bar
        objectName: "bar_" + row.agent
        visible: row.share >= 0
        x: 34 * Theme.mm + row.third
        y: 6.8 * Theme.mm
        width: 0.48 * row.third
        height: 5 * Theme.mm
        color: "transparent"
        border.width: row.share > 0.9 ? 2 : 1
        border.color: row.share > 0.9 ? Theme.warn : Theme.edge
        Repeater {
            model: row.parts
            Rectangle {
                required property int index
                required property var modelData
                x: modelData.from * bar.width
                width: Math.max(1, modelData.share * bar.width - 1)
                height: bar.height
                color: index % 2 === 0 ? Theme.edge : Theme.dim
                PlainLabel {
                    visible: parent.width > implicitWidth + 4
                    anchors.fill: parent
                    horizontalAlignment: Text.AlignHCenter
                    font.pixelSize: 2.9 * Theme.mm
                    color: parent.index % 2 === 0 ? Theme.text : Theme.ground
                    text: parent.modelData.name
                }
            }
        }
    }
    Words {
        x: row.share < 0 ? bar.x : bar.x + bar.width + 1.5 * Theme.mm
        y: 6.6 * Theme.mm
        width: row.width - x - 1.5 * Theme.mm
        color: Theme.dim
        text: row.queue
    }
}

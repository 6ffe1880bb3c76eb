// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: card
    required property Control control
    required property string name
    required property int number
    required property string glyph
    required property string holder
    required property string owner
    required property string headline
    required property string shortHeadline
    required property string token
    required property string shape
    required property string detail
    required property string shortDetail
    required property string battery
    required property string speed
    required property string goal
    required property string age
    required property string contact
    required property bool selected
    readonly property color ownerColour: owner === "mine" ? Theme.mine : owner === "other" ? Theme.other : Theme.none
    readonly property double faded: contact === "live" ? 1 : 0.5

    height: 21 * Theme.mm
    radius: 1 * Theme.mm
    color: selected ? Theme.raised : Theme.panel
    border.width: selected ? 3 : 1
    border.color: selected ? Theme.text : Theme.edge

    Rectangle {
        id: badge
        x: 1.6 * Theme.mm
        y: x
        width: 7 * Theme.mm
        height: width
        radius: width / 2
        color: card.ownerColour
        border.width: 1
        border.color: Theme.ink
        PlainLabel {
            anchors.fill: parent
            horizontalAlignment: Text.AlignHCenter
            text: card.number
            color: Theme.ink
            font.bold: true
        }
    }
    PlainLabel {
        objectName: "cardName"
        anchors.left: badge.right
        anchors.leftMargin: 1.4 * Theme.mm
        anchors.right: platform.left
        y: badge.y
        height: badge.height
        text: card.name
        font.bold: true
        font.pixelSize: 4 * Theme.mm
    }
    Glyph {
        id: platform
        kind: card.glyph
        colour: Theme.dim
        width: 6 * Theme.mm
        height: width
        anchors.right: word.left
        anchors.rightMargin: 1.2 * Theme.mm
        y: badge.y + 0.5 * Theme.mm
    }
    Chip {
        id: word
        objectName: "headline"
        anchors.right: parent.right
        anchors.rightMargin: 1.6 * Theme.mm
        y: badge.y + 1 * Theme.mm
        width: Math.min(implicitWidth, 38 * Theme.mm)
        text: card.headline
        brief: card.shortHeadline
        shape: card.shape
        fill: card.token === "ok" ? Theme.ok : card.token === "warn" ? Theme.warn : card.token === "bad" ? Theme.bad : Theme.none
    }
    FittedLabel {
        objectName: "detail"
        x: 2 * Theme.mm
        y: 9.4 * Theme.mm
        width: parent.width - 2 * x
        height: 5 * Theme.mm
        full: card.holder + "  ·  " + card.detail
        brief: card.shortDetail
    }
    Row {
        objectName: "values_" + card.name
        x: 2 * Theme.mm
        y: 15 * Theme.mm
        height: 5 * Theme.mm
        spacing: 3 * Theme.mm
        opacity: card.faded
        PlainLabel { text: card.battery; color: Theme.dim }
        PlainLabel { text: card.speed; color: Theme.dim }
        PlainLabel { text: card.goal === "" ? "" : "◇ " + card.goal; color: Theme.dim }
    }
    PlainLabel {
        objectName: "age_" + card.name
        anchors.right: parent.right
        anchors.rightMargin: 2 * Theme.mm
        y: 15 * Theme.mm
        height: 5 * Theme.mm
        text: card.contact === "live" ? card.age : card.age + " old"
        font.bold: card.contact !== "live"
        color: card.contact === "live" ? Theme.dim : Theme.text
    }
    Glyph {  // Its values are old.
        visible: card.contact !== "live"
        anchors.fill: parent
        kind: "frame"
        colour: Theme.warn
    }
    PressArea {
        objectName: "card_" + card.name
        anchors.fill: parent
        Accessible.role: Accessible.Button
        Accessible.name: card.name + " " + card.headline
        Accessible.description: card.detail
        Accessible.onPressAction: card.control.select(card.name, false)
        meaning: card.name
        holdTime: 600
        tapsToo: true
        onTapped: add => card.control.select(card.name, add)
        onHeld: card.control.select(card.name, true)
    }
}

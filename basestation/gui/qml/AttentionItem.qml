// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Something that needs the operator: a tap shows the robot.
Rectangle {
    id: item
    required property AttentionList attention
    required property string need
    required property bool urgent
    required property string who
    required property string shortWho
    required property string line
    required property string shortLine
    required property string since
    required property bool canSee
    required property bool canWait
    required property string grantLabel
    property int maximumLines: 2
    readonly property double wantedHeight: text.fullHeight + 3 * Theme.mm
    readonly property color ink: urgent ? Theme.ink : Theme.text

    radius: 1 * Theme.mm
    color: urgent ? Theme.bad : area.pressed ? Theme.edge : Theme.raised
    border.width: 1
    border.color: urgent ? Theme.ink : Theme.edge

    PressArea {
        id: area
        objectName: "show_" + item.need
        anchors.fill: parent
        Accessible.role: Accessible.Button
        Accessible.name: item.who + ": " + item.line
        Accessible.onPressAction: item.attention.show(item.need)
        meaning: item.need
        onTapped: item.attention.show(item.need)
    }
    Glyph {
        id: mark
        kind: item.urgent ? "square" : "triangle"
        colour: item.urgent ? Theme.ink : Theme.warn
        outline: Theme.ink
        width: 4.4 * Theme.mm
        height: width
        x: 2 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
    }
    FittedLabel {
        id: name
        objectName: "who_" + item.need
        anchors.left: mark.right
        anchors.leftMargin: 1.6 * Theme.mm
        width: Math.min(fullWidth, 30 * Theme.mm)
        height: parent.height
        wrapMode: Text.Wrap
        maximumLineCount: 2
        full: item.who
        brief: item.shortWho
        font.bold: true
        color: item.ink
    }
    FittedLabel {
        id: text
        objectName: "need_" + item.need
        anchors.left: name.right
        anchors.leftMargin: 2 * Theme.mm
        anchors.right: age.left
        height: parent.height
        wrapMode: Text.Wrap
        maximumLineCount: item.maximumLines
        full: item.line
        brief: item.shortLine
        color: item.ink
    }
    PlainLabel {
        id: age
        anchors.right: buttons.left
        anchors.rightMargin: 2 * Theme.mm
        height: parent.height
        text: item.since
        color: item.urgent ? Theme.ink : Theme.dim
    }
    Row {
        id: buttons
        anchors.right: parent.right
        anchors.rightMargin: 1 * Theme.mm
        anchors.verticalCenter: parent.verticalCenter
        height: item.height - 2 * Theme.mm
        spacing: 2 * Theme.mm
        HoldButton {
            objectName: "grant_" + item.need
            visible: item.grantLabel !== ""
            height: parent.height
            text: item.grantLabel
            hold: true
            meaning: item.need + item.grantLabel
            onFired: held => item.attention.grant(item.need, held)
        }
        HoldButton {
            objectName: "later_" + item.need
            visible: item.canWait
            height: parent.height
            text: item.grantLabel === "" ? "later" : "keep"
            meaning: item.need
            onFired: item.attention.later(item.need)
        }
        HoldButton {
            objectName: "see_" + item.need
            visible: item.canSee
            height: parent.height
            text: "seen"
            meaning: item.need
            onFired: item.attention.see(item.need)
        }
    }
}

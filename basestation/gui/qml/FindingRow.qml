// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: row
    required property TabState state_
    required property int number
    required property string importance
    required property string kind
    required property string robot
    required property string place
    required property string age
    required property string line
    required property string note
    required property string verdict
    required property string shape
    required property string token
    required property bool withdrawn
    required property bool removable
    required property string photo
    required property string photoState
    readonly property double textX: (photo === "" ? 7 : 25) * Theme.mm
    height: 14 * Theme.mm
    color: Theme.raised
    opacity: verdict === "rejected" || withdrawn ? 0.6 : 1
    border.width: state_.pickedFinding === number ? 2 : 0
    border.color: Theme.text

    PressArea {
        objectName: "finding_" + row.number
        width: buttons.x
        height: parent.height
        meaning: row.kind + row.number
        onTapped: row.state_.pickFinding(row.number)
        Accessible.role: Accessible.Button
        Accessible.name: row.number + " " + row.kind + " of " + row.robot
        Accessible.onPressAction: row.state_.pickFinding(row.number)
    }

    Glyph {
        x: 1.5 * Theme.mm
        y: 2 * Theme.mm
        width: 4 * Theme.mm
        height: width
        kind: row.shape
        colour: row.token === "ok" ? Theme.ok : row.token === "dim" ? Theme.dim : Theme.text
        outline: Theme.ink
    }
    Rectangle {
        visible: row.photo !== ""
        x: 7 * Theme.mm
        y: 1 * Theme.mm
        width: 16 * Theme.mm
        height: 12 * Theme.mm
        color: Theme.ground
        Image {
            objectName: "thumbnail_" + row.number
            anchors.fill: parent
            asynchronous: true
            cache: false
            fillMode: Image.PreserveAspectFit
            source: row.photo
        }
        PressArea {
            objectName: "photo_" + row.number
            anchors.fill: parent
            meaning: "photo" + row.number
            onTapped: row.state_.photos.show(row.number)
            Accessible.role: Accessible.Button
            Accessible.name: "photo of finding " + row.number
            Accessible.onPressAction: row.state_.photos.show(row.number)
        }
    }
    PlainLabel {
        x: row.textX
        y: 1 * Theme.mm
        width: buttons.x - x - 2 * Theme.mm
        height: 6 * Theme.mm
        font.bold: !row.withdrawn
        color: row.withdrawn ? Theme.dim : Theme.text
        text: row.number + "  " + row.kind + "   " + row.robot + "   " + (row.withdrawn ? row.verdict === "new" ? "withdrawn" : row.verdict + ", withdrawn" : row.verdict) + "   importance " + row.importance + "   at " + row.place + "   " + row.age
    }
    PlainLabel {
        objectName: "line_" + row.number
        x: row.textX
        y: 7 * Theme.mm
        width: buttons.x - x - 2 * Theme.mm
        height: 6 * Theme.mm
        color: Theme.dim
        text: (row.photoState === "" ? "" : "photo: " + row.photoState + "   ") + row.line + (row.note === "" ? "" : "  —  note: " + row.note)
    }
    Row {
        id: buttons
        x: parent.width - width - 1 * Theme.mm
        y: 0.5 * Theme.mm
        spacing: 1.5 * Theme.mm
        HoldButton {
            objectName: "confirm_" + row.number
            width: 26 * Theme.mm
            height: 13 * Theme.mm
            active: row.verdict === "confirmed"
            meaning: row.number + row.verdict
            text: active ? "confirmed" : "confirm"
            onFired: row.state_.judge(row.number, active ? "reopen" : "confirm")
        }
        HoldButton {
            objectName: "remove_" + row.number
            visible: row.removable
            width: 24 * Theme.mm
            height: 13 * Theme.mm
            meaning: row.number + row.verdict
            text: "remove"
            onFired: row.state_.removeMark(row.number)
        }
        HoldButton {
            objectName: "reject_" + row.number
            visible: !row.removable
            width: 24 * Theme.mm
            height: 13 * Theme.mm
            active: row.verdict === "rejected"
            meaning: row.number + row.verdict
            text: active ? "rejected" : "reject"
            onFired: row.state_.judge(row.number, active ? "reopen" : "reject")
        }
        HoldButton {
            objectName: "note_" + row.number
            width: 16 * Theme.mm
            height: 13 * Theme.mm
            active: row.state_.noting === row.number
            text: "note"
            onFired: row.state_.startNote(row.number)
        }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A camera of the grid: its picture with age and load, or the words of why there is none.
Rectangle {
    id: tile
    required property CameraGrid grid
    required property CameraFeeds feeds
    required property string robot
    required property string camera
    required property string role
    required property bool asks
    required property int limit
    required property double rate
    required property string why
    required property string load
    required property string shape
    required property string token
    property string name
    property bool large: false
    property bool marked: false
    readonly property bool off: role === "off"
    readonly property bool shownLarge: marked && role === "sharp"
    readonly property double line: 10.5 * Theme.mm
    // What the picture is, in one word.
    readonly property string word: shownLarge ? "large" : !asks ? role : picture.empty ? "waiting" : picture.stale ? "OLD" : "live"
    readonly property string note: shownLarge ? "shown large" : why !== "" ? why : !picture.empty ? "" : picture.problem !== "" ? picture.problem : "waits for a picture"
    color: Theme.raised
    border.width: marked || large ? 2 : 1
    border.color: marked || large ? Theme.goal : Theme.edge

    PressArea {
        objectName: "cameraChoose_" + tile.name
        anchors.fill: parent
        enabled: !tile.large
        meaning: tile.name
        onTapped: tile.grid.choose(tile.robot, tile.camera)
        Accessible.role: Accessible.Button
        Accessible.name: tile.robot + " " + tile.camera + ", " + tile.word
        Accessible.onPressAction: tile.grid.choose(tile.robot, tile.camera)
    }
    CameraItem {
        id: picture
        objectName: "camera_" + tile.name
        x: 2
        y: 2
        width: parent.width - 4
        height: parent.height - tile.line - 2
        visible: !tile.off && !tile.shownLarge
        feeds: tile.feeds
        robot: tile.robot
        camera: tile.camera
        active: tile.asks && Window.visibility !== Window.Hidden && Window.visibility !== Window.Minimized
        rest: tile.large ? 350 : 0
        limit: tile.limit
        rate: tile.rate
    }
    Column {
        visible: tile.note !== ""
        anchors.centerIn: picture
        width: picture.width - 2 * Theme.mm
        spacing: 1 * Theme.mm
        Glyph {
            visible: tile.shape !== "" && !tile.asks && picture.height > 20 * Theme.mm
            anchors.horizontalCenter: parent.horizontalCenter
            width: 4.5 * Theme.mm
            height: width
            kind: tile.shape
            colour: tile.token === "warn" ? Theme.warn : tile.token === "bad" ? Theme.bad : Theme.goal
            outline: Theme.ink
        }
        Rectangle {
            width: parent.width
            height: note.implicitHeight + 1 * Theme.mm
            color: tile.off || !picture.visible ? "transparent" : "#b0141414"
            PlainLabel {
                id: note
                objectName: "cameraNote_" + tile.name
                anchors.fill: parent
                horizontalAlignment: Text.AlignHCenter
                wrapMode: Text.Wrap
                maximumLineCount: 5
                color: tile.off || !picture.visible ? Theme.text : "white"
                text: tile.note
            }
        }
        HoldButton {
            objectName: "cameraOn_" + tile.name
            visible: tile.off
            anchors.horizontalCenter: parent.horizontalCenter
            height: 9 * Theme.mm
            width: 18 * Theme.mm
            text: "on"
            spoken: "switch " + tile.robot + " " + tile.camera + " on"
            onFired: tile.grid.switchOn(tile.robot, tile.camera, true)
        }
    }
    PlainLabel {
        objectName: "cameraName"
        x: 1.5 * Theme.mm
        y: parent.height - tile.line
        width: parent.width - x - (button.visible ? button.width : 0) - 1.5 * Theme.mm
        height: 5.2 * Theme.mm
        font.bold: true
        text: tile.robot + " " + tile.camera
    }
    Row {
        x: 1.5 * Theme.mm
        y: parent.height - tile.line + 5 * Theme.mm
        spacing: 1.5 * Theme.mm
        PlainLabel {
            objectName: "cameraWord_" + tile.name
            height: 5 * Theme.mm
            font.bold: true
            color: tile.shownLarge || tile.off ? Theme.dim : Theme.text
            text: tile.word
        }
        PlainLabel {
            objectName: "cameraAge_" + tile.name
            height: 5 * Theme.mm
            color: Theme.dim
            text: tile.large ? picture.ageText : picture.shortAge
        }
        PlainLabel {
            visible: tile.large
            height: 5 * Theme.mm
            color: Theme.dim
            text: tile.load
        }
    }
    Rectangle {
        visible: tile.load !== "" && !tile.large && picture.visible
        x: 2
        y: 2
        width: load.implicitWidth + 2 * Theme.mm
        height: 5 * Theme.mm
        color: "#b0141414"
        PlainLabel {
            id: load
            objectName: "cameraLoad_" + tile.name
            anchors.fill: parent
            anchors.leftMargin: 1 * Theme.mm
            color: "white"
            text: tile.load
        }
    }
    HoldButton {
        id: button
        objectName: "cameraOff_" + tile.name
        visible: !tile.off
        x: parent.width - width - 1 * Theme.mm
        y: parent.height - height - 1 * Theme.mm
        width: 9 * Theme.mm
        height: 8.5 * Theme.mm
        text: "off"
        spoken: "switch " + tile.robot + " " + tile.camera + " off"
        onFired: tile.grid.switchOn(tile.robot, tile.camera, false)
    }
}

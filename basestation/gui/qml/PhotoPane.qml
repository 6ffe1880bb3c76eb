// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The photo of a finding, as large as there is room. A press anywhere on it closes it, as Escape does.
Rectangle {
    id: pane
    required property PhotoView photos
    color: Theme.ground
    component Line: PlainLabel {
        width: parent.width
        height: 5.5 * Theme.mm
    }

    // The wheel does not reach the map below it.
    MouseArea {
        anchors.fill: parent
        acceptedButtons: Qt.NoButton
        onWheel: wheel => wheel.accepted = true
    }
    Image {
        id: picture
        objectName: "largePhoto"
        anchors.fill: parent
        anchors.margins: 2 * Theme.mm
        anchors.bottomMargin: caption.height + 2 * Theme.mm
        asynchronous: true
        cache: false
        fillMode: Image.PreserveAspectFit
        source: pane.visible ? pane.photos.source : ""
    }
    PlainLabel {
        visible: picture.status === Image.Loading
        anchors.centerIn: picture
        height: 8 * Theme.mm
        color: Theme.dim
        text: "loading"
    }
    Column {
        id: caption
        x: 3 * Theme.mm
        width: parent.width - 6 * Theme.mm
        y: parent.height - height - 1 * Theme.mm
        Line {
            objectName: "photoTitle"
            font.bold: true
            text: pane.photos.title + "   press or Esc: close"
        }
        Line {
            objectName: "photoText"
            visible: text !== ""
            height: implicitHeight
            wrapMode: Text.Wrap
            maximumLineCount: 3
            text: pane.photos.text
        }
        Line {
            objectName: "photoLine"
            color: Theme.dim
            text: pane.photos.line
        }
        Line {
            objectName: "photoState"
            height: implicitHeight
            wrapMode: Text.Wrap
            maximumLineCount: 2
            text: pane.photos.state
        }
    }
    PressArea {
        objectName: "closePhoto"
        anchors.fill: parent
        Accessible.role: Accessible.Button
        Accessible.name: "close the photo"
        Accessible.onPressAction: pane.photos.close()
        onTapped: pane.photos.close()
    }
}

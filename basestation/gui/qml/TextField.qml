// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A line that is typed. It keeps its keys for itself, but those that stop robots and open tabs.
Rectangle {
    id: field
    property alias text: input.text
    property string hint
    property bool first: false
    signal edited(string text)
    signal entered(string text)
    signal abandoned
    onAbandoned: input.focus = false

    implicitHeight: 8 * Theme.mm
    radius: 1 * Theme.mm
    color: Theme.ground
    border.width: input.activeFocus ? 2 : 1
    border.color: input.activeFocus ? Theme.goal : Theme.edge

    PlainLabel {
        visible: input.text === ""
        anchors.fill: input
        color: Theme.dim
        text: field.hint
    }
    TextInput {
        id: input
        objectName: field.objectName + "Input"
        anchors.fill: parent
        anchors.margins: 1 * Theme.mm
        Accessible.role: Accessible.EditableText
        Accessible.name: field.hint
        clip: true
        color: Theme.text
        selectionColor: Theme.goal
        selectedTextColor: Theme.ink
        selectByMouse: true
        verticalAlignment: TextInput.AlignVCenter
        font.pixelSize: 3.2 * Theme.mm
        maximumLength: 120
        onTextEdited: field.edited(text)
        onAccepted: field.entered(text)
        onVisibleChanged: focus = focus && visible
        Component.onCompleted: field.first && forceActiveFocus()
        Keys.priority: Keys.AfterItem
        Keys.onEscapePressed: field.abandoned()
        Keys.onPressed: event => event.accepted = event.key !== Qt.Key_Pause && (event.key < Qt.Key_F1 || event.key > Qt.Key_F12)
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A command typed by its words: proposals that can be tapped, the line, and the answer above it.
Rectangle {
    id: panel
    required property CommandLine line
    required property Control control
    visible: line.open
    height: content.height + 4 * Theme.mm
    color: Theme.panel
    border.width: 1
    border.color: Theme.goal
    onVisibleChanged: field.focus = visible

    Column {
        id: content
        x: 2 * Theme.mm
        y: 2 * Theme.mm
        width: parent.width - 4 * Theme.mm
        spacing: 1.5 * Theme.mm

        Flickable {
            visible: answer.text !== ""
            width: parent.width
            height: Math.min(answer.implicitHeight, 60 * Theme.mm)
            contentHeight: answer.implicitHeight
            clip: true
            boundsBehavior: Flickable.StopAtBounds
            PlainLabel {
                id: answer
                objectName: "commandAnswer"
                width: parent.width
                font.family: "monospace"
                font.pixelSize: 3 * Theme.mm
                maximumLineCount: 2000
                elide: Text.ElideNone
                wrapMode: Text.Wrap
                text: panel.line.answer
                color: panel.line.refused ? Theme.warn : Theme.text
            }
        }
        Flow {
            width: parent.width
            spacing: 1.5 * Theme.mm
            height: 9 * Theme.mm
            clip: true
            Repeater {
                model: panel.line.proposals
                HoldButton {
                    required property string modelData
                    objectName: "proposal_" + modelData
                    height: 9 * Theme.mm
                    text: modelData
                    onFired: panel.line.take(modelData)
                }
            }
        }
        Row {
            width: parent.width
            height: 9 * Theme.mm
            spacing: 2 * Theme.mm
            Rectangle {
                width: parent.width - run.width - close.width - 2 * parent.spacing
                height: parent.height
                color: Theme.ground
                border.width: 1
                border.color: Theme.edge
                TextInput {
                    id: field
                    objectName: "commandField"
                    Accessible.role: Accessible.EditableText
                    Accessible.name: "command"
                    anchors.fill: parent
                    anchors.margins: 1.5 * Theme.mm
                    color: Theme.text
                    font.pixelSize: 3.6 * Theme.mm
                    verticalAlignment: TextInput.AlignVCenter
                    maximumLength: 4000
                    clip: true
                    text: panel.line.line
                    onTextEdited: panel.line.line = text
                    Keys.onReturnPressed: panel.line.run()
                    Keys.onEnterPressed: panel.line.run()
                    Keys.onTabPressed: panel.line.complete()
                    Keys.onUpPressed: panel.line.recall(-1)
                    Keys.onDownPressed: panel.line.recall(1)
                    Keys.onEscapePressed: panel.line.open = false
                    Keys.onPressed: event => event.accepted = event.key === Qt.Key_Pause && panel.control.pressKey(event.key, 0, 0, event.isAutoRepeat)
                }
            }
            HoldButton {
                id: run
                objectName: "commandRun"
                width: 20 * Theme.mm
                height: parent.height
                text: "run"
                hold: panel.line.held
                meaning: panel.line.held ? panel.line.line : ""
                onFired: held => panel.line.run(held)
            }
            HoldButton {
                id: close
                objectName: "commandClose"
                width: 9 * Theme.mm
                height: parent.height
                text: "×"
                spoken: "close"
                onFired: panel.line.open = false
            }
        }
    }
}

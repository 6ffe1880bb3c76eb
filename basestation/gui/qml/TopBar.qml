// SPDX-License-Identifier: Apache-2.0
import QtQuick
import QtQuick.Layouts
import Adit

Rectangle {
    id: bar
    required property Control control
    color: control.silent ? Theme.bad : Theme.panel

    RowLayout {
        anchors.fill: parent
        anchors.leftMargin: 3 * Theme.mm
        anchors.rightMargin: 3 * Theme.mm
        spacing: 5 * Theme.mm
        property color ink: bar.control.silent ? Theme.ink : Theme.text

        PlainLabel {
            text: "ADIT  " + bar.control.operatorName
            font.pixelSize: 4.2 * Theme.mm
            font.bold: true
            color: parent.ink
            Layout.maximumWidth: 60 * Theme.mm
        }
        PlainLabel {
            text: bar.control.link === "" ? "link: no limit" : "link: " + bar.control.link
            color: parent.ink
            Layout.maximumWidth: 40 * Theme.mm
        }
        PlainLabel {
            objectName: "counts"
            text: bar.control.robotCount + " robots   " + bar.control.mineCount + " mine"
            color: parent.ink
        }
        Chip {
            visible: bar.control.lostCount > 0
            text: bar.control.lostCount + " LOST"
            shape: "square"
            fill: bar.control.silent ? Theme.none : Theme.bad
        }
        PlainLabel {
            visible: bar.control.silentText === ""
            text: bar.control.others === "" ? "no other station" : "with " + bar.control.others
            color: Theme.dim
            Layout.fillWidth: true
        }
        FittedLabel {
            objectName: "silent"
            visible: bar.control.silentText !== ""
            wrapMode: Text.Wrap
            maximumLineCount: 2
            Layout.fillHeight: true
            full: bar.control.silentText
            brief: bar.control.silentTextShort
            color: parent.ink
            font.bold: true
            Layout.fillWidth: true
        }
        HoldButton {
            objectName: "startStation"
            visible: bar.control.ended && !bar.control.viewOnly
            text: "Start the station again"
            onFired: bar.control.restartStation()
        }
    }
}

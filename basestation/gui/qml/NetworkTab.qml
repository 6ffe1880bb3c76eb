// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The link to each agent: what it carries of its budget, what is lost, and who does not hear us.
Item {
    id: tab
    required property Control control
    readonly property TabState state_: control.tabs

    ListView {
        id: list
        objectName: "network"
        anchors.fill: parent
        anchors.margins: 1.5 * Theme.mm
        clip: true
        spacing: 1
        boundsBehavior: Flickable.StopAtBounds
        model: tab.state_.network
        delegate: NetworkRow {
            width: list.width
        }
    }
    PlainLabel {
        visible: list.count === 0 || tab.state_.problem !== ""
        x: 3 * Theme.mm
        y: 2 * Theme.mm
        width: parent.width - 6 * Theme.mm
        height: 8 * Theme.mm
        color: tab.state_.problem === "" ? Theme.dim : Theme.text
        text: tab.state_.problem === "" ? "network: no link report yet; they come every 2 s" : "network: " + tab.state_.problem
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The link to each agent: what it carries of its budget, what is lost, and who does not hear us; or who hears whom.
Item {
    id: tab
    required property Control control
    readonly property TabState state_: control.tabs
    property bool matrix: false

    PlainList {
        id: list
        objectName: "network"
        visible: !tab.matrix
        anchors.bottomMargin: 12 * Theme.mm
        spacing: 1
        model: tab.state_.network
        delegate: NetworkRow {
            width: list.width
        }
    }
    HearingMatrix {
        visible: tab.matrix
        state_: tab.state_
        anchors.fill: parent
        anchors.margins: 1.5 * Theme.mm
        anchors.bottomMargin: 12 * Theme.mm
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
    PlainLabel {
        x: 3 * Theme.mm
        y: toggle.y
        width: toggle.x - x - 2 * Theme.mm
        height: toggle.height
        color: Theme.dim
        text: tab.matrix ? "Row hears column: heartbeats lost in percent. Blank: your station does not know." : "The bar: what an agent sends of its link profile's budget, by traffic class. Without a profile: no bar."
    }
    HoldButton {
        id: toggle
        objectName: "hearingToggle"
        x: parent.width - width - 2 * Theme.mm
        y: parent.height - height - 1 * Theme.mm
        width: 36 * Theme.mm
        height: 10 * Theme.mm
        text: tab.matrix ? "links" : "who hears whom"
        onFired: tab.matrix = !tab.matrix
    }
}

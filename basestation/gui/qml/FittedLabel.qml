// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A text that is never cut: where the full one has no room, a brief one stands in its place.
PlainLabel {
    id: label
    property string full
    property string brief: full
    readonly property double fullWidth: probe.implicitWidth
    readonly property double fullHeight: probe.implicitHeight

    text: probe.truncated ? brief : full
    PlainLabel {
        id: probe
        visible: false
        width: label.width
        height: label.height
        wrapMode: label.wrapMode
        maximumLineCount: label.maximumLineCount
        font: label.font
        text: label.full
    }
}

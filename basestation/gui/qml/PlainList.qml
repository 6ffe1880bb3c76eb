// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// Rows that fill a panel and stop at their ends.
ListView {
    anchors.fill: parent
    anchors.margins: 1.5 * Theme.mm
    clip: true
    boundsBehavior: Flickable.StopAtBounds
}

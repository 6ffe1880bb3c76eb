// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// A line of text. What comes by radio is never read as markup.
Text {
    textFormat: Text.PlainText
    color: Theme.text
    elide: Text.ElideRight
    verticalAlignment: Text.AlignVCenter
    font.pixelSize: 3.2 * Theme.mm
    maximumLineCount: 1
}

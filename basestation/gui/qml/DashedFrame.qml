// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The frame of something whose values are old.
Glyph {
    kind: "frame"
    colour: Theme.warn
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

// The cameras of all robots: the sharp one large, the others as thumbnails beside or below it. It asks for pictures only
// while it exists.
Item {
    id: wall
    required property Control control
    readonly property CameraGrid grid: control.cameras
    readonly property bool upright: height > width
    readonly property double gap: Math.round(1.5 * Theme.mm)
    // The picture has 4:3, and the thumbnails at least two columns.
    readonly property double sharpWidth: Math.floor(upright ? width - 2 * gap : Math.min((body.height - line) * 4 / 3, width - 82 * Theme.mm))
    readonly property double sharpHeight: Math.floor(Math.min(sharpWidth * 0.75 + line, (upright ? 0.4 : 1) * body.height))
    readonly property double line: 10.5 * Theme.mm
    readonly property size tileSize: grid.tileFor(grid.count, tiles.width, tiles.height, Theme.mm)
    Component.onCompleted: grid.watch(true)
    Component.onDestruction: grid.watch(false)

    Item {
        id: body
        x: wall.gap
        y: wall.gap
        width: parent.width - 2 * wall.gap
        height: foot.y - 2 * wall.gap
        Repeater {
            id: large
            model: wall.grid.large
            delegate: CameraTile {
                required property string tile
                required property bool sharp
                name: "sharp"
                grid: wall.grid
                feeds: wall.control.feeds
                large: true
                width: wall.sharpWidth
                height: wall.sharpHeight
            }
        }
        GridView {
            id: tiles
            objectName: "cameraTiles"
            x: wall.upright ? 0 : wall.sharpWidth + wall.gap
            y: wall.upright ? wall.sharpHeight + wall.gap : 0
            width: parent.width - x + wall.gap
            height: parent.height - y
            clip: true
            boundsBehavior: Flickable.StopAtBounds
            cacheBuffer: 0  // What is out of sight asks for nothing.
            currentIndex: -1  // The current item would never leave sight.
            model: wall.grid.tiles
            cellWidth: wall.tileSize.width
            cellHeight: wall.tileSize.height
            delegate: CameraTile {
                id: tile_
                required property string tile
                required property bool sharp
                name: robot + "_" + camera
                grid: wall.grid
                feeds: wall.control.feeds
                marked: sharp
                width: tiles.cellWidth - wall.gap
                height: tiles.cellHeight - wall.gap
                Component.onCompleted: tile_.grid.see(tile_.robot, tile_.camera, true)
                Component.onDestruction: tile_.grid.see(tile_.robot, tile_.camera, false)
            }
        }
    }
    PlainLabel {
        objectName: "noCameras"
        visible: large.count === 0
        anchors.centerIn: parent
        height: 8 * Theme.mm
        color: Theme.dim
        text: wall.grid.without
    }
    Column {
        id: foot
        x: wall.gap
        y: parent.height - height - 0.5 * Theme.mm
        width: parent.width - 2 * wall.gap
        component Line: PlainLabel {
            width: parent.width
            color: Theme.dim
            wrapMode: Text.Wrap
            maximumLineCount: 3
            visible: text !== ""
        }
        Line { objectName: "cameraSummary"; text: wall.grid.summary }
        Line { objectName: "camerasWithout"; visible: text !== "" && large.count > 0; text: wall.grid.without }
        Line { objectName: "cameraKeys"; text: "A tap on a thumbnail, or the keys ← and →, make a camera the large one." }
    }
}

// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: pane
    required property Control control
    color: Theme.ground
    border.width: control.aiming ? 3 : 0
    border.color: Theme.goal

    MapView {
        id: map
        objectName: "map"
        Accessible.role: Accessible.Canvas
        Accessible.name: "map from above"
        anchors.fill: parent
        anchors.margins: pane.border.width
        control: pane.control
        visible: !pane.control.solid
    }
    MapView3D {
        id: solid
        objectName: "solid"
        Accessible.role: Accessible.Canvas
        Accessible.name: "map in three dimensions"
        anchors.fill: parent
        anchors.margins: pane.border.width
        control: pane.control
        visible: pane.control.solid
    }
    Connections {
        target: pane.control
        function onCut_moved(steps) { solid.moveCut(steps) }
    }
    PlainLabel {
        visible: pane.control.solid ? solid.empty : map.empty
        anchors.horizontalCenter: parent.horizontalCenter
        y: 4 * Theme.mm
        color: Theme.dim
        text: "no map yet: only what robots report of themselves"
    }
    AreaMenu {
        area: pane.control.area
        anchors.horizontalCenter: parent.horizontalCenter
        anchors.bottom: parent.bottom
        anchors.bottomMargin: 3 * Theme.mm
    }
    Column {
        anchors.right: parent.right
        anchors.top: parent.top
        anchors.margins: 2 * Theme.mm
        spacing: 2 * Theme.mm
        HoldButton {
            objectName: "fitAll"
            width: 22 * Theme.mm
            height: 10 * Theme.mm
            text: map.fitting && !pane.control.solid ? "● fit all" : "fit all"
            onFired: pane.control.solid ? solid.fitAll() : map.fitAll()
        }
        HoldButton {
            objectName: "solidToggle"
            width: 22 * Theme.mm
            height: 10 * Theme.mm
            text: pane.control.solid ? "2D  v" : "3D  v"
            onFired: pane.control.solid = !pane.control.solid
        }
        HoldButton {
            objectName: "cutToggle"
            visible: pane.control.solid
            width: 22 * Theme.mm
            height: 10 * Theme.mm
            active: solid.cutting
            text: solid.cutting ? "≤ " + solid.cut.toFixed(1) + " m" : "all heights"
            onFired: solid.toggleCut()
        }
        HoldButton {
            objectName: "areaToggle"
            visible: !pane.control.solid
            width: 22 * Theme.mm
            height: 10 * Theme.mm
            active: pane.control.area.active
            text: "area"
            onFired: pane.control.area.active = !pane.control.area.active
        }
        HoldButton {
            anchors.right: parent.right
            width: 10 * Theme.mm
            height: width
            objectName: "zoomIn"
            text: "+"
            spoken: "zoom in"
            onFired: pane.control.solid ? solid.zoomBy(1.5) : map.zoomBy(1.5)
        }
        HoldButton {
            anchors.right: parent.right
            width: 10 * Theme.mm
            height: width
            objectName: "zoomOut"
            text: "−"
            spoken: "zoom out"
            onFired: pane.control.solid ? solid.zoomBy(1 / 1.5) : map.zoomBy(1 / 1.5)
        }
    }
}

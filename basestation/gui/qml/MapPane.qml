// SPDX-License-Identifier: Apache-2.0
import QtQuick
import Adit

Rectangle {
    id: pane
    required property Control control
    property double covered: 0
    property double coveredRight: 0
    color: Theme.ground
    border.width: control.aiming || control.mark.active ? 3 : 0
    border.color: Theme.goal

    MapView {
        id: map
        objectName: "map"
        Accessible.role: Accessible.Canvas
        Accessible.name: "map from above"
        anchors.fill: parent
        anchors.margins: pane.border.width
        control: pane.control
        covered: pane.covered
        coveredRight: pane.coveredRight
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
        covered: pane.covered
        coveredRight: pane.coveredRight
        visible: pane.control.solid
    }
    Connections {
        target: pane.control
        function onCut_moved(steps) { pane.control.solid ? solid.moveCut(steps) : map.moveFloor(steps) }
        function onZoomed(factor) { pane.control.solid ? solid.zoomBy(factor) : map.zoomBy(factor) }
    }
    PlainLabel {
        visible: pane.control.solid ? solid.empty : map.empty
        anchors.horizontalCenter: parent.horizontalCenter
        y: 4 * Theme.mm
        color: Theme.dim
        text: "no map yet: only what robots report of themselves"
    }
    Rectangle {
        visible: map.reception && !pane.control.solid
        x: 1 * Theme.mm
        y: 1 * Theme.mm
        width: Math.min(legend.implicitWidth + 3 * Theme.mm, pane.width - 48 * Theme.mm)
        height: 6 * Theme.mm
        color: Theme.panel
        PlainLabel {
            id: legend
            objectName: "receptionLegend"
            anchors.fill: parent
            anchors.leftMargin: 1.5 * Theme.mm
            text: map.receptionLegend
        }
    }
    AreaMenu {
        area: pane.control.area
        anchors.horizontalCenter: parent.horizontalCenter
        anchors.bottom: parent.bottom
        anchors.bottomMargin: 3 * Theme.mm
    }
    MarkMenu {
        mark: pane.control.mark
        anchors.horizontalCenter: parent.horizontalCenter
        anchors.bottom: parent.bottom
        anchors.bottomMargin: 3 * Theme.mm
    }
    component Wide: HoldButton {
        width: 22 * Theme.mm
        height: 10 * Theme.mm
    }
    component Square: HoldButton {
        width: 10 * Theme.mm
        height: width
    }
    Column {
        anchors.right: parent.right
        anchors.top: parent.top
        anchors.margins: 2 * Theme.mm
        anchors.rightMargin: 2 * Theme.mm + pane.coveredRight
        spacing: 2 * Theme.mm
        Wide {
            objectName: "fitAll"
            anchors.right: parent.right
            text: (pane.control.solid ? solid.fitting : map.fitting) ? "● fit all" : "fit all"
            onFired: pane.control.solid ? solid.fitAll() : map.fitAll()
        }
        Wide {
            objectName: "solidToggle"
            anchors.right: parent.right
            text: pane.control.solid ? "2D  v" : "3D  v"
            onFired: pane.control.solid = !pane.control.solid
        }
        Wide {
            objectName: "cutToggle"
            anchors.right: parent.right
            visible: pane.control.solid
            active: solid.cutting
            text: solid.cutting ? "≤ " + solid.cut.toFixed(1) + " m" : "all heights"
            onFired: solid.toggleCut()
        }
        Wide {
            objectName: "followToggle"
            anchors.right: parent.right
            active: pane.control.follow.robot !== ""
            text: "follow  f"
            onFired: pane.control.follow.toggle()
        }
        Wide {
            objectName: "headingToggle"
            anchors.right: parent.right
            visible: pane.control.follow.robot !== "" || pane.control.follow.headingUp
            active: pane.control.follow.headingUp && pane.control.follow.robot !== ""
            text: "ahead ↑  u"
            spoken: "the heading of the robot is up"
            onFired: pane.control.follow.toggleHeading()
        }
        Row {
            visible: (pane.control.solid ? solid.floor : map.floor) !== ""
            anchors.right: parent.right
            spacing: 1 * Theme.mm
            Square { objectName: "floorDown"; text: "↓"; spoken: "lower floor"; onFired: pane.control.solid ? solid.moveFloor(-1) : map.moveFloor(-1) }
            Square { objectName: "floorUp"; text: "↑"; spoken: "higher floor"; onFired: pane.control.solid ? solid.moveFloor(1) : map.moveFloor(1) }
            HoldButton {
                objectName: "floorToggle"
                width: 30 * Theme.mm
                height: 10 * Theme.mm
                active: pane.control.solid ? solid.floorAutomatic : map.floorAutomatic
                text: pane.control.solid ? solid.floor : map.floor
                onFired: pane.control.solid ? solid.toggleFloor() : map.toggleFloor()
            }
        }
        Row {
            visible: !pane.control.solid
            anchors.right: parent.right
            spacing: 1 * Theme.mm
            layoutDirection: Qt.RightToLeft
            Wide {
                objectName: "areaToggle"
                visible: !pane.control.viewOnly
                active: pane.control.area.active
                text: "area"
                onFired: pane.control.area.active = !pane.control.area.active
            }
            Wide {
                objectName: "receptionToggle"
                active: map.reception
                text: "signal"
                onFired: map.reception = !map.reception
            }
        }
        Wide {
            objectName: "markToggle"
            visible: !pane.control.viewOnly
            anchors.right: parent.right
            active: pane.control.mark.active
            text: "mark"
            onFired: pane.control.mark.active = !pane.control.mark.active
        }
        Row {
            anchors.right: parent.right
            spacing: 2 * Theme.mm
            Square { objectName: "zoomOut"; text: "−"; spoken: "zoom out"; onFired: pane.control.solid ? solid.zoomBy(1 / 1.5) : map.zoomBy(1 / 1.5) }
            Square { objectName: "zoomIn"; text: "+"; spoken: "zoom in"; onFired: pane.control.solid ? solid.zoomBy(1.5) : map.zoomBy(1.5) }
        }
    }
}

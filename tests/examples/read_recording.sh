#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# usage: read_recording.sh PROGRAM RECORDING CSV: what example 6 prints and writes of example 2's recording
set -euo pipefail
printed="$("$1" "$2" "$3")"
# RobotState is published at 10 Hz for the 60 s of the rehearsal.
grep -qE '^ +[56][0-9][0-9] +(9|10)\.[0-9]{2}  r1/adit/robot_state$' <<< "$printed" || { echo "$printed"; exit 1; }
awk -F, '
  NR == 1 { if ($0 != "time,robot,x,y,yaw") { print "header: " $0; exit wrong = 1 } next }
  { ++rows; if ($2 != "r1") { print "robot " $2; exit wrong = 1 } }
  # The circle has a radius of 3 m around the origin.
  $3 > right { right = $3 } $3 < left { left = $3 } $4 > top { top = $4 }
  END { if (wrong || rows < 500 || right < 2 || left > -2 || top < 2) { print rows, right, left, top; exit 1 } }' "$3"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# perception.sh ODOMETRY ALIGN MAP FOLDER: runs the examples of perception on clouds of a room of 8 x 6 x 3 m, whose
# lidar moves by 0.1 m each along x.
set -euo pipefail
rm -rf "$4" && mkdir -p "$4/clouds"
for n in 0 1 2 3 4 5 6 7 8 9; do
  awk -v n="$n" 'BEGIN {
    srand(n + 1); count = 6000
    print "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " count "\nHEIGHT 1"
    print "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS " count "\nDATA ascii"
    for (i = 0; i < count; ++i) {
      p[0] = 8 * rand() - 4; p[1] = 6 * rand() - 3; p[2] = 3 * rand() - 1
      low[0] = -4; low[1] = -3; low[2] = -1; high[0] = 4; high[1] = 3; high[2] = 2
      side = int(3 * rand()); p[side] = (rand() < 0.5 ? low[side] : high[side]) + 0.02 * (rand() - 0.5)
      printf "%.4f %.4f %.4f\n", p[0] - 0.1 * n, p[1], p[2]
    } }' > "$4/clouds/$n.pcd"
done
"$1" "$4/clouds" "$4/path.tum"
tail -1 "$4/path.tum" | awk '{ exit !($2 > 0.87 && $2 < 0.93 && $3 * $3 + $4 * $4 < 0.0009) }'
"$2" "$4/clouds/0.pcd" "$4/clouds/4.pcd" | tee "$4/align.txt"
grep -qE '^\((0.39|0.40|0.41)' "$4/align.txt"
"$3" "$4/clouds" "$4/path.tum" "$4/map"
for file in map.bt map.pcd map.pgm map.yaml; do test -s "$4/$file"; done

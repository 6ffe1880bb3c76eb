#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares `perctool eval` with the results that evo stores beside its test data.

usage: check_evo.py EVO/test/data PERCTOOL
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import zipfile


def quaternion(m):
    """x, y, z, w of a rotation matrix, by its largest component."""
    trace = m[0][0] + m[1][1] + m[2][2]
    q = [1 + 2 * m[0][0] - trace, 1 + 2 * m[1][1] - trace, 1 + 2 * m[2][2] - trace, 1 + trace]
    n = max(range(4), key=lambda i: q[i])
    s = 2 * q[n] ** 0.5
    if n == 3:
        return [(m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4]
    a, b = (n + 1) % 3, (n + 2) % 3
    out = [0.0] * 4
    out[n] = s / 4
    out[a] = (m[a][n] + m[n][a]) / s
    out[b] = (m[b][n] + m[n][b]) / s
    out[3] = (m[b][a] - m[a][b]) / s
    return out


def to_tum(kitti, tum):
    """KITTI's poses have no stamps: their numbers serve as such."""
    lines = []
    for number, line in enumerate(kitti.read_text().splitlines()):
        v = [float(word) for word in line.split()]
        q = quaternion([v[0:3], v[4:7], v[8:11]])
        lines.append(" ".join(repr(x) for x in [float(number), v[3], v[7], v[11], *q]))
    tum.write_text("\n".join(lines) + "\n")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    data, perctool = pathlib.Path(sys.argv[1]), sys.argv[2]
    worst = 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for trajectory in ("gt", "ORB", "SPTAM"):
            to_tum(data / f"KITTI_00_{trajectory}.txt", folder / f"{trajectory}.tum")
        for trajectory in ("orb", "sptam"):
            for error, key, options in (("ape", "ate", ["--align"]), ("rpe", "rpe", ["--delta", "10", "--unit", "m"])):
                with zipfile.ZipFile(data / "res_files" / f"{trajectory}_{error}.zip") as stored:
                    expected = json.loads(stored.read("stats.json"))
                command = [perctool, "eval", folder / "gt.tum", folder / f"{trajectory.upper()}.tum", "--json"]
                got = json.loads(subprocess.check_output(command + options))[key]
                for statistic, value in expected.items():
                    off = abs(got[statistic] - value) / max(1.0, abs(value))
                    worst = max(worst, off)
                    if off > 1e-6:
                        print(f"{trajectory} {error} {statistic}: {got[statistic]} instead of {value}")
    print(f"largest difference: {worst:.2e}")
    sys.exit(0 if worst <= 1e-6 else 1)


if __name__ == "__main__":
    main()

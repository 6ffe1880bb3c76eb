#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# usage: unit.sh BUILD_FOLDER. Has systemd read the unit that is installed; 77 where there is no systemd.
set -euo pipefail
command -v systemd-analyze > /dev/null || { echo "no systemd-analyze here: the unit is not verified"; exit 77; }
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
# The program need not be installed yet.
sed 's#^ExecStart=[^ ]*/robot_agent#ExecStart=/bin/true#' "$1/adit-robot@.service" > "$scratch/adit-robot@.service"
cd "$scratch"
said="$(systemd-analyze verify ./adit-robot@r1.service 2>&1)" || { echo "$said"; exit 1; }
# It warns of keys that it does not know, and still ends with 0.
[ -z "$said" ] || { echo "$said"; exit 1; }

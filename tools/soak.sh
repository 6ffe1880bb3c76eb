#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The soak with a network and a /dev/shm of its own, so that nothing of others is counted: tools/soak.sh [--for 600] [--every 10]
# Needs root; without it the soak runs where it is. Exit status 0: flat.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
soak="${ADIT_BIN:-$root/build/release/bin}/soak"
[ -x "$soak" ] || { echo "soak: no $soak; build it first: ./run build release adit_benches" >&2; exit 2; }
if unshare --net --mount true 2> /dev/null; then
  # shellcheck disable=SC2016
  exec unshare --net --mount sh -c 'mount -t tmpfs tmpfs /dev/shm && ip link set lo up && exec "$@"' soak "$soak" "$@"
fi
exec "$soak" "$@"

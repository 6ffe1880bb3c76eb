#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Checks that isolated.sh makes a network of its own in a chroot whose root is no mount point. Exit status 77: not as this
# user, or not on this machine.
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
[ "$EUID" = 0 ] && mountpoint -q / && "$here/isolated.sh" --possible || exit 77
root="$(mktemp -d)"
# Only empty folders are removed: what is mounted there is mounted for that one command alone.
trap 'rmdir "$root"/* "$root"' EXIT
for folder in bin dev etc lib lib64 proc sbin tmp usr; do
  [ ! -d "/$folder" ] || mkdir "$root/$folder"
done
mkdir "$root/live"
# shellcheck disable=SC2016
unshare --mount sh -ec '
  for folder in "$0"/*; do mount --rbind "/$(basename "$folder")" "$folder" 2> /dev/null || mount --bind "$1" "$folder"; done
  exec chroot "$0" /live/isolated.sh --possible' "$root" "$here"

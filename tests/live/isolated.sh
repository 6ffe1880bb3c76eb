#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# usage: tests/live/isolated.sh PROGRAM ARGUMENT...   runs a live test with a network of its own (loopback alone) and with
#                                                     folders of its own; what it started ends with it, and when it
#                                                     passes its folders are removed
#        tests/live/isolated.sh --possible            exit status 0 where such a network can be made; otherwise says why
# Where it cannot be made, tests run one after the other: each holds a lock.
set -u
PATH="$PATH:/usr/sbin:/sbin"
separate=(unshare --net --pid --fork --kill-child --mount-proc)
# The root of a chroot is often no mount point, so its propagation cannot be made private: then only that of /proc is.
mountpoint -q / || separate+=(--propagation unchanged)
[ "$EUID" = 0 ] || separate+=(--user --map-root-user)

case "$*" in
  --possible) exec "${separate[@]}" ip link set lo up 2>&1 ;;
  *--gtest_list_tests*) exec "$@" ;;
esac

temporary="${TMPDIR:-/tmp}" scratch="${TMPDIR:-/tmp}/adit.$$.$RANDOM"
mkdir -m 700 "$scratch" "$scratch"/{home,run,state,cache,tmp} || exit 1
export HOME="$scratch/home" XDG_RUNTIME_DIR="$scratch/run" XDG_STATE_HOME="$scratch/state" XDG_CACHE_HOME="$scratch/cache"

# `prepared` shows that the exit status is the test's, ADIT_OWN_NETWORK the test that it is alone in its network. All
# other processes end with this shell, process 1 of their own.
# shellcheck disable=SC2016
TMPDIR="$scratch/tmp" "${separate[@]}" \
  sh -c 'ip link set lo up && : > "$0/prepared" && ADIT_OWN_NETWORK=1 "$@"; exit $?' "$scratch" "$@"
status=$?
if [ ! -e "$scratch/prepared" ]; then
  echo "isolated.sh: no network of its own can be made here: one live test after the other" >&2
  # TMPDIR stays: DDS domains are reserved by locks in it (process.cpp).
  flock --close "$temporary/adit-live-$EUID.lock" "$@"
  status=$?
fi
if [ $status = 0 ]; then rm -rf "$scratch"; else echo "isolated.sh: files of the test: $scratch" >&2; fi
exit $status

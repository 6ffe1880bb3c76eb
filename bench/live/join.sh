#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# How long ten robots and a station take until they know each other: the shipped programs over Fast DDS on the loopback
# of a network namespace of its own (needs root). The time runs from the start of the first agent until `list` at the
# station shows platform, mode, holder and pose of all robots. Two builds are compared by naming both folders.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
usage() {
  cat <<'TEXT'
usage: bench/live/join.sh [--runs N] [--robots N] [--link LINK] [BIN[:slam]...]
  BIN         folders of programs, in turn in each run; default build/release/bin
  BIN:slam    the same with perception: slam and the full lidar, so that robots send their maps
  --runs N    runs of each folder, default 5
  --robots N  1 to 10, default 10
  --link L    profile of config/links for robots and station, default none
TEXT
}
runs=5 count=10 link="" variants=()
while [ $# -gt 0 ]; do
  case "$1" in
    --runs) runs="${2:?--runs needs a number}"; shift ;;
    --robots) count="${2:?--robots needs a number}"; shift ;;
    --link) link="${2:?--link needs a name}"; shift ;;
    -h|--help) usage; exit 0 ;;
    -*) echo "join: unknown option '$1'" >&2; usage >&2; exit 2 ;;
    *:slam) variants+=("$(cd "${1%:slam}" && pwd):slam") ;;
    *) variants+=("$(cd "$1" && pwd)") ;;
  esac
  shift
done
[ ${#variants[@]} -gt 0 ] || variants=("$root/build/release/bin")
for variant in "${variants[@]}"; do
  for program in robot_agent basestation simulate; do
    [ -x "${variant%:slam}/$program" ] || { echo "join: no $program in ${variant%:slam}" >&2; exit 2; }
  done
done
if [ "${ADIT_JOIN_ALONE:-no}" = no ]; then
  options=(--runs "$runs" --robots "$count")
  [ -z "$link" ] || options+=(--link "$link")
  # shellcheck disable=SC2016
  ADIT_JOIN_ALONE=yes exec unshare --net --mount sh -c \
    'mount -t tmpfs tmpfs /dev/shm && ip link set lo up && exec "$@"' join "${BASH_SOURCE[0]}" "${options[@]}" "${variants[@]}"
fi

home="" bin="" pids=()
finish() {
  [ -z "$home" ] || "$bin/basestation" --name op1 --domain 77 down > /dev/null 2>&1 || true
  for pid in "${pids[@]}"; do kill -TERM "$pid" 2> /dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2> /dev/null || true; done
  [ -z "$home" ] || rm -rf "$home"
  home="" pids=()
}
trap finish EXIT
trap 'exit 130' INT TERM

# joined: robots of which the station knows all
joined() {
  "$bin/basestation" --name op1 --domain 77 list 2> /dev/null |
    awk '$1 ~ /^r[0-9]+$/ && $2 != "-" && $3 != "?" && $4 != "?" && $7 != "-" { n++ } END { print n + 0 }'
}

# once VARIANT FILE: one start of all programs; writes the seconds into the file
once() {
  local slam=no
  [[ "$1" != *:slam ]] || slam=yes
  bin="${1%:slam}"
  home="$(mktemp -d)"
  export XDG_RUNTIME_DIR="$home" XDG_STATE_HOME="$home" HOME="$home" ADIT_CONFIG="$bin/../../../config"
  local scenario="$home/scenario.yaml" name platform x y yaw number=0 options=()
  cp "$root/config/scenarios/ten_robots.yaml" "$scenario"
  [ "$slam" = no ] || sed -i 's/^lidar: planar/lidar: full/' "$scenario"
  [ -z "$link" ] || options=(--link "$link")
  : > "$home/simulate.log"
  "$bin/simulate" "$scenario" --domain-base 10 --await-script > "$home/simulate.log" 2>&1 &
  pids+=("$!")
  until grep -q "simulate: ready" "$home/simulate.log"; do
    kill -0 "${pids[0]}" 2> /dev/null || { cat "$home/simulate.log" >&2; exit 1; }
    sleep 0.1
  done
  local begin="$EPOCHREALTIME"
  while read -r name platform x y yaw; do
    number=$((number + 1))
    [ "$number" -le "$count" ] || break
    printf 'name: %s\nplatform: %s\npose: [%s, %s, %s]\nradio: {domain: 77}\nrobot_domain: %s\n' \
      "$name" "$platform" "$x" "$y" "$yaw" "$((10 + number))" > "$home/$name.yaml"
    [ "$slam" = no ] || echo 'perception: slam' >> "$home/$name.yaml"
    "$bin/robot_agent" --supervised --config "$home/$name.yaml" "${options[@]}" > "$home/$name.log" 2>&1 &
    pids+=("$!")
  done < <(sed -n 's/^ *- {id: \([a-z0-9]*\), platform: \([a-z]*\), pose: \[\([^,]*\), *\([^,]*\), *\([^]]*\)\]}.*/\1 \2 \3 \4 \5/p' "$scenario")
  "$bin/basestation" --name op1 --domain 77 "${options[@]}" up > "$home/op1.log" 2>&1 || { cat "$home/op1.log" >&2; exit 1; }
  until [ "$(joined)" = "$count" ]; do
    sleep 0.05
    awk "BEGIN { exit $EPOCHREALTIME - $begin < 60 }" || continue
    echo "join: only $(joined) of $count robots after 60 s" >&2
    tail -n 2 "$home"/*.log >&2
    exit 1
  done
  awk "BEGIN { printf \"%.2f\", $EPOCHREALTIME - $begin }" > "$2"
  finish
}

result="$(mktemp)" rows="$(mktemp)"
for ((run = 1; run <= runs; run++)); do
  for variant in "${variants[@]}"; do
    before="$(cut -d' ' -f1 /proc/loadavg)"
    once "$variant" "$result"
    printf '%s %s\n' "$(cat "$result")" "$variant" >> "$rows"
    printf 'join: %s s, load %s before, %s\n' "$(cat "$result")" "$before" "$variant"
  done
done
for variant in "${variants[@]}"; do
  awk -v variant="$variant" '$2 == variant { print $1 }' "$rows" | sort -n |
    awk -v variant="$variant" '{ t[NR] = $1 }
      END { printf "%s: %d runs, median %.2f s, %.2f to %.2f s\n", variant, NR, t[int((NR + 1) / 2)], t[1], t[NR] }'
done
rm -f "$result" "$rows"

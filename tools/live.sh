#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# A scenario live: simulate, an agent a robot, a station an operator, each a process of its own, over Fast DDS on loopback.
# The script is played, places and contacts are judged by what was true. Exit status 0 when all of them hold.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
bin="${ADIT_BIN:-$root/build/release/bin}"

usage() {
  cat <<'TEXT'
usage: tools/live.sh SCENARIO.yaml [--keep FOLDER]
  --keep FOLDER   logs, recordings, report and picture of the run
TEXT
}

scenario="" keep=""
while [ $# -gt 0 ]; do
  case "$1" in
    --keep) keep="${2:?--keep needs a folder}"; shift ;;
    -h|--help) usage; exit 0 ;;
    -*) echo "live: unknown option '$1'" >&2; usage >&2; exit 2 ;;
    *) scenario="$1" ;;
  esac
  shift
done
[ -f "$scenario" ] || { echo "live: no scenario '$scenario'" >&2; usage >&2; exit 2; }
[ -x "$bin/simulate" ] || { echo "live: no programs in $bin; build them first: ./run build" >&2; exit 2; }

robots="$(sed -n 's/^ *- {id: \([a-z0-9]*\), platform: \([a-z]*\), pose: \[\([^,]*\), *\([^,]*\), *\([^]]*\)\]}.*/\1 \2 \3 \4 \5/p' "$scenario")"
operators="$(sed -n '/^basestations:/,/^[a-z]*:$/s/^ *- {id: \([a-z0-9]*\),.*/\1/p' "$scenario")"
count="$(wc -l <<< "$robots")"
[ -n "$robots" ] && [ -n "$operators" ] || { echo "live: $scenario names no robots or no basestations, one a line" >&2; exit 2; }

# A radio domain, and behind it one for each robot: whole groups of five, by the lock that tests and demo take, too.
groups=$(( (count + 1 + 4) / 5 ))
domain="" held=()
for first in 10 25 40 55 80; do
  held=()
  for ((i = 0; i < groups; i++)); do
    { exec {lock}> "${TMPDIR:-/tmp}/adit-domains-$((first + 5 * i)).lock"; } 2> /dev/null || break
    held+=("$lock")
    flock -n "$lock" || break
    [ $((i + 1)) -lt "$groups" ] || domain="$first"
  done
  [ -z "$domain" ] || break
  for lock in "${held[@]}"; do exec {lock}>&-; done
done
[ "$groups" -le 3 ] && [ -n "$domain" ] || { echo "live: no $groups groups of DDS domains are free" >&2; exit 1; }

home="$(mktemp -d "${TMPDIR:-/tmp}/adit-live-XXXXXX")"
export XDG_RUNTIME_DIR="$home" XDG_STATE_HOME="$home"
pids=()
finish() {
  trap - EXIT INT TERM
  for name in $operators; do "$bin/basestation" --name "$name" down --leave > /dev/null 2>&1 || true; done
  for pid in "${pids[@]}"; do kill -TERM "$pid" 2> /dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2> /dev/null || true; done
  if [ -n "$keep" ]; then
    mkdir -p "$keep"
    cp -r "$home"/*.log "$home"/adit/recordings "$home"/report.json "$home"/picture.png "$keep"/ 2> /dev/null || true
  fi
  rm -rf "$home"
}
trap finish EXIT
trap 'echo "live: interrupted" >&2; exit 130' INT TERM

until_true() {  # SECONDS WHAT COMMAND...
  local tries=$(( $1 * 10 )) what="$2"
  shift 2
  until "$@" > /dev/null 2>&1; do
    tries=$((tries - 1))
    [ "$tries" -gt 0 ] || { echo "live: $what" >&2; tail -n 3 "$home"/*.log >&2; exit 1; }
    sleep 0.1
  done
}

"$bin/simulate" "$scenario" --domain-base "$domain" --await-script --report "$home/report.json" \
  --picture "$home/picture.png" > "$home/simulate.log" 2>&1 &
simulator=$!
pids+=("$simulator")
until_true 30 "the simulator did not come up" grep -q "simulate: ready" "$home/simulate.log"

begin="$EPOCHREALTIME"
number=0
while read -r name platform x y yaw; do
  number=$((number + 1))
  printf 'name: %s\nplatform: %s\npose: [%s, %s, %s]\nradio: {domain: %s}\nrobot_domain: %s\n' \
    "$name" "$platform" "$x" "$y" "$yaw" "$domain" "$((domain + number))" > "$home/$name.yaml"
  "$bin/robot_agent" --supervised --config "$home/$name.yaml" > "$home/$name.log" 2>&1 &
  pids+=("$!")
done <<< "$robots"
for name in $operators; do
  read -ra at <<< "$(sed -n "/^basestations:/,/^[a-z]*:$/s/^ *- {id: $name, pose: \[\([^],]*\), *\([^],]*\).*/--at \1 \2 0/p" "$scenario")"
  "$bin/basestation" --name "$name" --domain "$domain" "${at[@]}" up > "$home/$name.log" 2>&1 ||
    { cat "$home/$name.log" >&2; exit 1; }
done
for name in $operators; do
  while read -r robot _; do
    until_true 30 "operator $name does not see robot $robot" "$bin/basestation" --name "$name" status "$robot"
  done <<< "$robots"
done
printf 'live: %s robots known to %s operators after %.1f s\n' "$count" "$(wc -w <<< "$operators")" \
  "$(awk "BEGIN { print $EPOCHREALTIME - $begin }")"

kill -USR1 "$simulator"  # the scenario's time begins
play=0
"$bin/basestation" --name "${operators%%$'\n'*}" run "$scenario" --all || play=$?
for pid in "${pids[@]}"; do
  kill -0 "$pid" 2> /dev/null || { echo "live: a process has ended" >&2; tail -n 3 "$home"/*.log >&2; exit 1; }
done
kill -INT "$simulator"
verdict=0
wait "$simulator" || verdict=$?
cat "$home/simulate.log"
[ "$play" -le 1 ] || { echo "live: the play ended with status $play" >&2; exit 1; }
echo "live: $([ "$verdict" = 0 ] && echo "everything holds" || echo FAILED)"
exit "$verdict"

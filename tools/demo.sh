#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The demo: a real building, several robots and operators, each in a process of its own, over Fast DDS on loopback.
# Called by ./run demo; see --help there. Exit status 0 only if everything that the scenario expects came true.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
bin="$root/build/release/bin"
scenario="$root/config/scenarios/demo.yaml"
out="$root/build/demo"
watch=no
gui=no
film=no
for argument in "$@"; do
  case "$argument" in
    --watch) watch=yes ;;
    --gui) gui=yes ;;
    --film) film=yes scenario="$root/config/scenarios/film.yaml" ;;
    --team) scenario="$root/config/scenarios/demo_team.yaml" ;;
    -h|--help)
      echo "usage: ./run demo [--watch|--gui [--film]] [--team]"
      echo "  --watch   the operator's dashboard instead of the narration"
      echo "  --gui     the window of op1; without a screen, its picture build/demo/window.png"
      echo "  --film    with --gui: the window works by itself and is filmed, build/demo/gui.mp4"
      echo "  --team    robots that drive together"
      exit 0 ;;
    *) echo "demo: unknown option '$argument'; usage: ./run demo [--watch|--gui [--film]] [--team]" >&2; exit 2 ;;
  esac
done

# Robots and operators of the scenario.
mapfile -t robots < <(sed -n 's/^ *- {id: \([a-z0-9]*\), platform: .*/\1/p' "$scenario")
mapfile -t operators < <(sed -n 's/^ *- {id: \(op[0-9]*\), pose: .*/\1/p' "$scenario")

say() { printf '\033[1m%s\033[0m\n' "$*"; }

# Identities, sockets and logs of this run only, so that it meets no station of the user's.
home="$(mktemp -d "${TMPDIR:-/tmp}/adit-demo-XXXXXX")"
export XDG_RUNTIME_DIR="$home" XDG_STATE_HOME="$home"
mkdir -p "$out"
# A radio domain of its own; the robots' domains follow it. The lock is the tests' as well (tests/live/process.hpp).
domain="${ADIT_DEMO_DOMAIN:-}"
for group in 40 45 50 55 60 65 70 80 85 90 95; do
  [ -z "$domain" ] || break
  { exec {domain_lock}>"${TMPDIR:-/tmp}/adit-domains-$group.lock"; } 2>/dev/null || continue
  if flock -n "$domain_lock"; then domain=$group; else exec {domain_lock}>&-; fi
done
[ -n "$domain" ] || { echo "demo: all DDS domains are taken; name one with ADIT_DEMO_DOMAIN" >&2; exit 1; }
pids=()

finish() {
  trap - EXIT INT TERM
  for name in "${operators[@]}"; do
    "$bin/basestation" --name "$name" --domain "$domain" down --leave >/dev/null 2>&1 || true
  done
  for pid in "${pids[@]}"; do kill -TERM "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  cp "$home"/*.log "$out"/ 2>/dev/null || true
  rm -rf "$home"
}
trap finish EXIT
trap 'echo; echo "demo: interrupted" >&2; exit 130' INT TERM

wait_for() {  # FILE TEXT SECONDS WHAT
  local tries=$(( $3 * 10 ))
  until grep -q "$2" "$1" 2>/dev/null; do
    tries=$((tries - 1))
    if [ "$tries" -le 0 ]; then
      echo "demo: $4 did not come up; its log:" >&2
      tail -5 "$1" >&2
      exit 1
    fi
    sleep 0.1
  done
}

length="$(sed -n 's/^duration: *\([0-9]*\).*/\1/p' "$scenario")"
say "Adit: ${#robots[@]} robots in the corridor of a real building, operators ${operators[*]}, about $((length + 10)) s"
echo "  the building   geb079 (OctoMap's example data, University of Freiburg)"
echo "  on the air     Fast DDS on loopback, radio domain $domain"

"$bin/simulate" "$scenario" --domain-base "$domain" --await-script --report "$out/report.json" --picture "$out/demo.png" \
  > "$home/simulate.log" 2>&1 &
simulator=$!
pids+=("$simulator")
wait_for "$home/simulate.log" "simulate: ready" 30 "the simulator"

number=0
while read -r name platform x y yaw camera; do
  number=$((number + 1))
  printf '  %-14s %s, at %s %s\n' "robot $name" "$platform" "$x" "$y"
  if [ -n "$camera" ]; then  # A camera is part of a platform.
    printf '%s\nsensors: {%s}\n' "$(cat "$root/config/platforms/$platform.yaml")" "$camera" > "$home/$name.platform.yaml"
    platform="$home/$name.platform.yaml"
  fi
  printf 'name: %s\nplatform: "%s"\npose: [%s, %s, %s]\nradio: {domain: %s}\nrobot_domain: %s\ntree: trees/robot.xml\nperception: slam\n' \
    "$name" "$platform" "$x" "$y" "$yaw" "$domain" "$((domain + number))" > "$home/$name.yaml"
  "$bin/robot_agent" --supervised --config "$home/$name.yaml" > "$home/$name.log" 2>&1 &
  pids+=("$!")
done < <(sed -n 's/^ *- {id: \([a-z0-9]*\), platform: \([a-z]*\), pose: \[\([^,]*\), *\([^,]*\), *\([^]]*\)\]\(, \(camera: {.*}\)\)\{0,1\}}.*/\1 \2 \3 \4 \5 \7/p' "$scenario")
[ "$number" = "${#robots[@]}" ] ||
  { echo "demo: ${scenario#"$root"/} has ${#robots[@]} robots, of which $number could be read" >&2; exit 1; }

for name in "${operators[@]}"; do
  "$bin/basestation" --name "$name" --domain "$domain" up > "$home/$name.log" 2>&1 ||
    { cat "$home/$name.log" >&2; exit 1; }
  printf '  %-14s station on the air\n' "operator $name"
done
# Each operator sees all robots before the first order.
for name in "${operators[@]}"; do
  for robot in "${robots[@]}"; do
    tries=100
    until "$bin/basestation" --name "$name" --domain "$domain" status "$robot" >/dev/null 2>&1; do
      tries=$((tries - 1))
      [ "$tries" -gt 0 ] || { echo "demo: operator $name does not see robot $robot; logs are in $out" >&2; exit 1; }
      sleep 0.1
    done
  done
done
echo

# The window of op1. Without a screen it is drawn all the same, and its picture taken while the robots are under way.
picture_after=40
window=()
if [ "$gui$film" = yesno ]; then
  [ -x "$bin/adit_gui" ] || { echo "demo: there is no $bin/adit_gui: ./run demo --gui builds it" >&2; exit 1; }
  window=("$bin/adit_gui" --name op1 --domain "$domain" --select "${robots[1]}" --camera)
  if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    echo "  window         of op1; keys and gestures are in docs/gui.md"
  else
    rm -f "$out/window.png"
    window=(env QT_QPA_PLATFORM=offscreen QT_QUICK_BACKEND=software "${window[@]}" --size 1920x1080
      --screenshot "$out/window.png" --after "$picture_after")
    echo "  window         of op1: no screen, so its picture after $picture_after s"
  fi
  "${window[@]}" > "$home/gui.log" 2>&1 &
  pids+=("$!")
fi

play=0
kill -USR1 "$simulator"  # the scenario's time begins
if [ "$film" = yes ]; then
  rm -f "$out/gui.mp4"
  "$bin/basestation" --name op2 --domain "$domain" run "$scenario" > "$out/narration.log" 2>&1 &
  pids+=("$!")
  echo "  film           about a minute and a half"
  "$bin/gui_film" op1 "$domain" "$out/gui.mp4" || { echo "demo: the film failed" >&2; exit 1; }
elif [ "$watch" = yes ]; then
  "$bin/basestation" --name op1 --domain "$domain" run "$scenario" --all > "$out/narration.log" 2>&1 &
  player=$!
  pids+=("$player")
  # The dashboard ends with the play, or by q.
  (while kill -0 "$player" 2>/dev/null; do sleep 0.5; done; pkill -TERM -P $$ -f "$bin/basestation .* watch" || true) &
  pids+=("$!")
  "$bin/basestation" --name op1 --domain "$domain" watch || true
  if kill -0 "$player" 2>/dev/null; then kill -INT "$player"; fi
  wait "$player" || play=$?
else
  "$bin/basestation" --name op1 --domain "$domain" run "$scenario" --all | tee "$out/narration.log" || play=$?
fi

"$bin/basestation" --name op1 --domain "$domain" map status > "$out/map.txt" 2>&1 || true
map=yes
"$bin/basestation" --name op1 --domain "$domain" map picture "$out/map.png" > "$home/map.log" 2>&1 || map=no
kill -INT "$simulator"
verdict=0
wait "$simulator" || verdict=$?
echo
say "What was true in the simulated building"
grep -v -e "simulate: ready" -e "on domain" "$home/simulate.log" | sed 's/^/  /'
echo "  picture        ${out#"$root"/}/demo.png"
echo "  report         ${out#"$root"/}/report.json"
if [ "$film" = yes ]; then
  echo "  film           ${out#"$root"/}/gui.mp4"
elif [ "$gui" = yes ] && [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  if [ -s "$out/window.png" ]; then
    echo "  window         ${out#"$root"/}/window.png"
  else
    echo "demo: the window left no picture; its log:" >&2
    tail -5 "$home/gui.log" >&2
    play=2
  fi
fi
say "The map that the station of op1 holds"
sed 's/^/  /' "$out/map.txt"
if [ "$map" = yes ]; then echo "  map            ${out#"$root"/}/map.png"; else sed 's/^/  /' "$home/map.log"; fi
if [ "$verdict" = 0 ]; then
  say "Everything that was expected came true, and nothing was touched."
else
  say "The demo FAILED: see above; logs are in ${out#"$root"/}."
fi
[ "$play" -le 1 ] || { echo "demo: the operators' play ended with status $play" >&2; exit 1; }
exit "$verdict"

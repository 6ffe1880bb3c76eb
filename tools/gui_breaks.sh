#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Builds the window with each rule of basestation/gui/break.hpp broken on purpose, and checks that the tests named here
# fail then, and pass without it. usage: tools/gui_breaks.sh [RULE...]
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 2
build=build/gui_breaks
jobs="${ADIT_JOBS:-$(nproc)}"

# RULE | program | tests that must notice it
rules() {
  cat <<'TEXT'
stop_confirm | test_gui_window | Window.AStopOfAllLeavesAtFingerDown
bound_stick | test_gui_window | DriveWindow.TheStickIsBoundToItsRobotAndNotToTheSelection
stale_fade | test_gui_window | Window.OldValuesAreFadedAndSaidToBeOld
all_implied | test_gui_scene | ActionBar.NamesTheRobotsInTheLine
TEXT
}

# make RULE TARGET: builds that program with the rule broken; without a rule, an unbroken one
make() {
  cmake --preset release -B "$build" -DADIT_GUI_BREAK="$1" > "$build.log" 2>&1 &&
    nice -n 5 cmake --build "$build" -j "$jobs" --target "$2" >> "$build.log" 2>&1
}

mkdir -p build
status=0
printf '%-14s %-70s %s\n' rule test result
while IFS='| ' read -r rule program test; do
  [ $# -eq 0 ] || [[ " $* " == *" $rule "* ]] || continue
  if ! make "$rule" "$program"; then
    tail -20 "$build.log" >&2
    result='DOES NOT BUILD' status=1
  elif "$build/bin/$program" --gtest_filter="$test" > "$build-$rule.log" 2>&1; then
    result='NOT NOTICED' status=1
  elif grep -q "FAILED  \] $test" "$build-$rule.log"; then
    result='fails, as it must'
  else
    result="DID NOT RUN ($build-$rule.log)" status=1
  fi
  printf '%-14s %-70s %s\n' "$rule" "$test" "$result"
done < <(rules)

# The same tests without a broken rule.
while read -r program; do
  tests="$(rules | awk -F' *[|] *' -v program="$program" '$2 == program { printf "%s%s", colon, $3; colon = ":" }')"
  if make '' "$program" && "$build/bin/$program" --gtest_filter="$tests" > "$build-none.log" 2>&1; then
    result='pass'
  else
    result='FAIL' status=1
  fi
  printf '%-14s %-70s %s\n' none "all of $program" "$result"
done < <(rules | cut -d'|' -f2 | tr -d ' ' | sort -u)
exit $status

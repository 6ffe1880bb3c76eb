#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of docs/gui again, and leaves those of further states in build/pictures.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case "${1:-}" in
  "") ;;
  *)
    echo "usage: tools/screenshots.sh"
    echo "  writes build/pictures/*.png with the tests of the window, and copies those that docs/gui has."
    echo "  Build the tests first: ./run build release adit_tests. docs/gui/demo.png is of ./run demo --gui."
    [ "$1" = --help ] && exit 0 || exit 2
    ;;
esac
program=build/release/bin/test_gui_window
[ -x "$program" ] || { echo "screenshots: there is no $program: ./run build release adit_tests makes it, where Qt 6 is installed" >&2; exit 1; }
pictures="$PWD/build/pictures"
mkdir -p "$pictures"
ADIT_GUI_PICTURES="$pictures" "$program" --gtest_brief=1
missing=0
for picture in docs/gui/*.png; do
  name="$(basename "$picture")"
  [ "$name" != demo.png ] || continue
  if [ -f "$pictures/$name" ]; then
    cp "$pictures/$name" "$picture"
  else
    echo "screenshots: no test makes $name" >&2
    missing=1
  fi
done
echo "screenshots: $(ls "$pictures" | wc -l) pictures in build/pictures"
exit "$missing"

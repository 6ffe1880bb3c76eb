#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# shellcheck disable=SC2034  # failed is read where this is sourced
# What the tests of tools/lint.sh share: a tree of their own, and what the lint says of it. Sourced.
lint="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/tools/lint.sh"
tree="$(mktemp -d)"
trap 'rm -rf "$tree"' EXIT
failed=0

# put FILE TEXT: TEXT may hold \n.
put() { mkdir -p "$tree/$(dirname "$1")"; printf '%b' "$2" > "$tree/$1"; }

# expect CHECK TEXT: the check fails and says so; expect CHECK "": it passes.
expect() {
  local out status
  out="$("$lint" --root "$tree" "$1" 2>&1)"
  status=$?
  if [ -n "$2" ]; then
    if [ $status -ne 1 ] || ! grep -qF -- "$2" <<< "$out"; then
      echo "$1: expected a finding '$2', got ($status): $out"
      failed=1
    fi
  elif [ $status -ne 0 ]; then
    echo "$1: expected nothing, got: $out"
    failed=1
  fi
}

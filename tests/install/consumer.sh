#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# usage: consumer.sh CMAKE BUILD_FOLDER CONSUMER_FOLDER
set -euo pipefail
cmake="$1" build="$2" source="$3"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/prefix" > "$scratch/log" || { cat "$scratch/log"; exit 1; }
"$cmake" -S "$source" -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/prefix" > "$scratch/log" ||
  { cat "$scratch/log"; exit 1; }
"$cmake" --build "$scratch/build"
# Beside the installed programs, the consumer finds the installed configuration.
mkdir -p "$scratch/prefix/bin"
cp "$scratch/build/consumer" "$scratch/prefix/bin/"
cd / && env -u ADIT_CONFIG "$scratch/prefix/bin/consumer"
# A program elsewhere, without ADIT_CONFIG, has none, and says where it looked.
if "$scratch/build/consumer" 2> "$scratch/log"; then exit 1; fi
grep -q 'platforms/legged.yaml: no such file' "$scratch/log"

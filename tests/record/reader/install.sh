#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fetches the independent reader into a build folder, once. usage: install.sh FOLDER
# Exit status 77: it cannot be had here (no npm, no registry); tests that need it are skipped then.
set -uo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
folder="${1:?usage: install.sh FOLDER}"
command -v node > /dev/null && command -v npm > /dev/null || { echo "node or npm is not installed: ./run setup"; exit 77; }
mkdir -p "$folder" || exit 1
exec 9> "$folder/lock"
flock 9
cp "$here/read.mjs" "$folder/read.mjs" || exit 1
cmp -s "$here/package.json" "$folder/installed.json" && exit 0
# Not tried again for each test when it has just failed.
[ -z "$(find "$folder/failed" -mmin -10 2> /dev/null)" ] || { echo "npm could not fetch it a moment ago"; exit 77; }
cp "$here/package.json" "$folder/package.json" || exit 1
# -k: npm without a network does not always heed a TERM. 9>&-: whatever it leaves behind must not keep the lock.
(cd "$folder" && exec 9>&- && timeout -k 5 90 npm install --no-audit --no-fund --no-package-lock --ignore-scripts --loglevel=error \
  --fetch-retries=1 --fetch-timeout=20000) || { touch "$folder/failed"; exit 77; }
cp "$here/package.json" "$folder/installed.json"

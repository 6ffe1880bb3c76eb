#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Keeps what the fuzzer of the radio's guard found: reduces build/fuzz/corpus_datagrams to inputs that reach something of
# their own, and packs them into tests/wire/datagrams.corpus, which every `./run test` plays. Run tools/fuzz.sh before.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
least="$(mktemp -d)"
trap 'rm -rf "$least"' EXIT
build/fuzz/bin/fuzz_rtps_guard -merge=1 "$least" build/fuzz/corpus_datagrams > /dev/null 2>&1
for file in "$least"/*; do
  printf '%06d' "$(stat -c %s "$file")"
  cat "$file"
done > tests/wire/datagrams.corpus
echo "keep_corpus: $(find "$least" -type f | wc -l) inputs in tests/wire/datagrams.corpus"

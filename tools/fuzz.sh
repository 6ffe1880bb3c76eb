#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Gives made-up bytes of a station to the client's readers, made-up pieces of maps, findings, photos and pictures to
# their decoders, made-up models to the reader of ONNX files, and made-up datagrams to the guard of the radio, with
# libFuzzer and the sanitizers. usage: tools/fuzz.sh [SECONDS [PROGRAM...]]   (of each, default 300; programs:
# fuzz_client, fuzz_piece, fuzz_finding_piece, fuzz_photo_piece, fuzz_picture_piece, fuzz_onnx_input, fuzz_rtps_guard,
# default all). What it finds is in build/fuzz/found, its inputs are in build/fuzz/corpus*. Exit status 77: Clang with
# libFuzzer is not installed.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 2
seconds="${1:-300}"
programs=("${@:2}")
[ ${#programs[@]} -gt 0 ] || programs=(fuzz_client fuzz_piece fuzz_finding_piece fuzz_photo_piece fuzz_picture_piece fuzz_onnx_input
  fuzz_rtps_guard)
build=build/fuzz
probe="$(mktemp -d)"
trap 'rm -rf "$probe"' EXIT
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' > "$probe/a.cpp"
if ! clang++ -fsanitize=fuzzer "$probe/a.cpp" -o "$probe/a" 2> /dev/null; then
  echo "fuzz: Clang with libFuzzer is not installed (clang)" >&2
  exit 77
fi
mkdir -p "$build/corpus" "$build/found"
cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
  -DADIT_SANITIZE=address,undefined,fuzzer-no-link -DADIT_WERROR=OFF -DADIT_BENCH=OFF -DADIT_FUZZ=ON \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON > "$build/configure.log" 2>&1 ||
  { tail -20 "$build/configure.log" >&2; exit 1; }
nice -n 5 cmake --build "$build" -j "${ADIT_JOBS:-$(nproc)}" --target "${programs[@]}" > "$build/build.log" 2>&1 ||
  { tail -30 "$build/build.log" >&2; exit 1; }
status=0
fuzz() {  # PROGRAM CORPUS LENGTH
  echo "fuzz: $1"
  mkdir -p "$2"
  nice -n 5 "$build/bin/$1" -max_total_time="$seconds" -max_len="$3" -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix="$build/found/" "$2" > "$build/run.log" 2>&1 || status=1
  tail -12 "$build/run.log"
}
for program in "${programs[@]}"; do
  case "$program" in
    fuzz_client)
      ADIT_FUZZ_SEEDS="$build/corpus" "$build/bin/fuzz_client" -runs=0 > /dev/null 2>&1
      fuzz fuzz_client "$build/corpus" 60000 ;;
    fuzz_piece) fuzz fuzz_piece "$build/corpus_pieces" 1300 ;;
    fuzz_rtps_guard)
      mkdir -p "$build/corpus_datagrams"
      ADIT_FUZZ_SEEDS="$build/corpus_datagrams" "$build/bin/fuzz_rtps_guard" -runs=0 > /dev/null 2>&1
      fuzz fuzz_rtps_guard "$build/corpus_datagrams" 2900 ;;
    fuzz_finding_piece) fuzz fuzz_finding_piece "$build/corpus_finding_pieces" 1300 ;;
    fuzz_photo_piece) fuzz fuzz_photo_piece "$build/corpus_photo_pieces" 8000 ;;
    fuzz_picture_piece) fuzz fuzz_picture_piece "$build/corpus_picture_pieces" 4000 ;;
    fuzz_onnx_input) fuzz fuzz_onnx_input "$build/corpus_onnx" 4000 ;;
  esac
done
exit $status

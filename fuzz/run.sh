#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the fuzz targets with clang and sanitizers and runs them, each from the kept corpus.
# usage: fuzz/run.sh [SECONDS] [TARGET...]     SECONDS: of each (600); TARGET: a folder of fuzz/corpus
# A finding stays in build/fuzz/findings/, and the script then fails.
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
  -h|--help) sed -n '3,5s/^# //p' "$0"; exit 0 ;;
esac
seconds=${1:-600}
[[ $seconds =~ ^[0-9]+$ ]] || { echo "run.sh: $seconds is no number of seconds" >&2; exit 2; }
targets=("${@:2}")
[[ ${#targets[@]} -gt 0 ]] || mapfile -t targets < <(cd fuzz/corpus && ls -d */ | tr -d /)

command -v clang++ >/dev/null ||
  { echo "run.sh: needs the Debian packages clang and libclang-rt-dev" >&2; exit 1; }

cmake -S . -B build/fuzz -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1 \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DMASKED_MAPPER_FUZZ=ON \
  -DMASKED_MAPPER_STRICT=OFF -DMASKED_MAPPER_TESTS=OFF -DMASKED_MAPPER_INSTALL=OFF >/dev/null
cmake --build build/fuzz -j "$(nproc)" --target "${targets[@]/#/masked_mapper_fuzz_}"

mkdir -p build/fuzz/findings
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
for target in "${targets[@]}"; do
  found=build/fuzz/corpus/$target
  mkdir -p "$found"
  log=build/fuzz/$target.log
  # What is large is only slower to mutate, not harder to read.
  nice "build/fuzz/fuzz/masked_mapper_fuzz_$target" -max_total_time="$seconds" -timeout=30 \
    -rss_limit_mb=2048 -max_len=200000 -artifact_prefix="build/fuzz/findings/$target-" \
    "$found" "fuzz/corpus/$target" >"$log" 2>&1 ||
    { tail -n 60 "$log" >&2; echo "run.sh: $target has a finding" >&2; exit 1; }
  echo "$target: $(tail -n 1 "$log")"
done

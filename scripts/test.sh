#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up, builds, and runs every test and check.
# usage: scripts/test.sh [PART...]     parts, in order; the first three without an argument:
#   setup      install missing Debian packages
#   release    release build and all tests
#   format     clang-format has nothing to change
# Beside these, on request only, since they take as long again or longer:
#   tidy       clang-tidy finds nothing
#   sanitize   address and undefined-behaviour build and all tests
#   coverage   a build that counts lines, all tests, a table by gcovr
#   package    Debian packages; the unpacked program runs, a project builds against the library
set -euo pipefail
cd "$(dirname "$0")/.."

jobs=$(nproc)
parts=("$@")
[[ ${#parts[@]} -gt 0 ]] || parts=(setup release format)

say() { printf '\n== %s\n' "$*"; }

configure() {  # preset
  local log="build/$1/configure.log"
  mkdir -p "build/$1"
  cmake --preset "$1" >"$log" 2>&1 || { cat "$log" >&2; return 1; }
}

build_and_test() {  # preset
  configure "$1"
  cmake --build --preset "$1" -j "$jobs"
  ctest --preset "$1" -j "$jobs" 2>&1 | tee "build/$1/ctest.log"
}

part_setup() { scripts/setup.sh; }

part_release() { build_and_test release; }

part_format() { scripts/format.sh --check; }

part_tidy() {
  configure tidy
  run-clang-tidy -p build/tidy -quiet -j "$jobs" "$PWD/(src|apps|examples)/" \
    >build/tidy.log 2>build/tidy.errors || { grep -vE '^(/usr/bin/)?clang-tidy|^$' build/tidy.log; return 1; }
}

# By clang, which also sees numbers that fit no integer; so it builds with both compilers.
part_sanitize() {
  scripts/install_packages.sh clang libclang-rt-dev
  export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
  build_and_test sanitize
}

part_coverage() {
  build_and_test coverage
  gcovr --root . --filter include/ --filter src/ build/coverage
}

part_package() { scripts/package.sh; }

for part in "${parts[@]}"; do
  case $part in
    setup|release|format|tidy|sanitize|coverage|package) ;;
    -h|--help) sed -n '3,12s/^# //p' "$0"; exit 0 ;;
    *) echo "test.sh: unknown part '$part' (try --help)" >&2; exit 2 ;;
  esac
done

started=$SECONDS
closing=()
for part in "${parts[@]}"; do
  say "$part"
  part_started=$SECONDS
  # Not inside `if`: there, set -e would be off within the part.
  trap 'say "FAILED: $part after $((SECONDS - part_started)) s"' ERR
  "part_$part"
  closing+=("$part: $((SECONDS - part_started)) s")
done

say "all passed in $((SECONDS - started)) s"
printf '%s\n' "${closing[@]}"
for preset in release sanitize; do
  [[ " ${parts[*]} " == *" $preset "* ]] || continue
  echo "$preset tests: $(grep -h 'tests passed' "build/$preset/ctest.log")"
done

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Formats the C++ sources in place; with --check only says what is not formatted, and fails then.
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=(-i)
[[ "${1:-}" == --check ]] && arguments=(--dry-run -Werror)
find include src apps tests examples benchmarks fuzz \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
  sort -z | xargs -0 -r clang-format --style=file "${arguments[@]}"

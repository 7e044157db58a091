#!/usr/bin/env bash
# Fails when a source is not as .clang-format would have it; `scripts/check-format.sh --fix` mends them.
set -euo pipefail
cd "$(dirname "$0")/.."
mode=(--dry-run --Werror)
[[ ${1:-} == --fix ]] && mode=(-i)
find core topology geometry io slab edit cases ranks study view tools python tests bench examples \( -name '*.cpp' -o -name '*.h' \) -print0 |
    xargs -0 clang-format "${mode[@]}"

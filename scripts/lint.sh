#!/usr/bin/env bash
# Runs clang-tidy by .clang-tidy over the product's sources, in the groups of a unity build: each header is read once.
#   scripts/lint.sh [FOLDER]     FOLDER: a unity build's, by default build/lint, which is configured and not built
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/lint}
[[ -f $build/compile_commands.json ]] ||
    cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
        -DSLABHULL_TESTS=OFF -DSLABHULL_UNITY=ON >/dev/null
rooms='core|topology|geometry|io|slab|edit|cases|ranks|study|view|tools|python'
sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$build/compile_commands.json" | sort -u |
    xargs -d '\n' -n 1 -P "$(nproc)" clang-tidy-16 --quiet -p "$build" \
        --header-filter="^$PWD/($rooms)/" --checks=-bugprone-suspicious-include \
            --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-shadow 2> >(grep -v 'warnings generated' >&2)

#!/usr/bin/env bash
# Installs what is missing, builds the release preset and runs its tests. scripts/check.sh has the sanitizers and the rest.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install-deps.sh --test
scripts/check-format.sh
scripts/build.sh release -DSLABHULL_TESTS=ON -DSLABHULL_UNITY=ON
ctest --test-dir build/release --no-tests=error --output-on-failure -LE long -j $(($(nproc) + 1)) # some wait for files and children

#!/usr/bin/env bash
# Installs what is missing, builds both presets and runs all tests: optimised, then under the sanitizers all but those
# labelled "large".
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install-deps.sh --test
scripts/check-format.sh
scripts/build.sh release -DSLABHULL_TESTS=ON
ctest --test-dir build/release --no-tests=error --output-on-failure -j "$(nproc)"
scripts/build.sh dev -DSLABHULL_TESTS=ON
ctest --test-dir build/dev --no-tests=error --output-on-failure -j "$(nproc)" -LE large

#!/usr/bin/env bash
# What scripts/test.sh leaves out, by name or all:
#   sanitizers   all tests but those labelled "large", under AddressSanitizer and UndefinedBehaviorSanitizer
#   long         the tests labelled "long", of the release preset: many rounds of what shorter tests do, too
#   threads      the tests labelled "parallel", under ThreadSanitizer
#   lint         clang-tidy over all sources, by .clang-tidy
#   docs         Doxygen over the public headers, and the documentation site; warnings are errors, and links lead somewhere
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install-deps.sh --test

run_tests() { # PRESET [options of ctest]
    scripts/build.sh "$1" -DSLABHULL_TESTS=ON -DSLABHULL_UNITY=ON
    ctest --test-dir "build/$1" --no-tests=error --output-on-failure -j $(($(nproc) + 1)) "${@:2}"
}
check_sanitizers() { run_tests dev -LE large; }
check_long() { run_tests release -L long; }
check_threads() { run_tests tsan -L parallel; }
check_lint() {
    scripts/install-deps.sh --lint
    scripts/lint.sh
}
check_docs() {
    cmake --preset release -DSLABHULL_SITE=ON -DSLABHULL_UNITY=ON >/dev/null
    cmake --build --preset release --target docs site
}

checks=("$@")
((${#checks[@]})) || checks=(sanitizers long threads lint docs)
for check in "${checks[@]}"; do
    declare -F "check_$check" >/dev/null || { echo "check.sh: there is no check \"$check\"" >&2; exit 2; }
done
for check in "${checks[@]}"; do
    begin=$SECONDS
    "check_$check"
    echo "== $check: $((SECONDS - begin)) s"
done

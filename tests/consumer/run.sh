#!/usr/bin/env bash
# Installs a build tree to a fresh prefix, then configures, builds and runs projects against it: that of a stranger, and
# the example of a solver, which must leave no file behind.
# Usage: run.sh <build tree> <scratch directory> <source of the consumer> <source of the solver>
set -euo pipefail
build=$1 scratch=$2 consumer=$3 solver=$4
rm -rf "$scratch"
mkdir -p "$scratch/run" "$scratch/solver-run"
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null

build_project() { # SOURCE FOLDER
    cmake -S "$1" -B "$2" -G Ninja -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_BUILD_TYPE=Release >/dev/null
    cmake --build "$2"
}
build_project "$consumer" "$scratch/consumer"
build_project "$solver" "$scratch/solver"
(cd "$scratch/run" && ../consumer/consumer)
"$scratch/prefix/bin/slabhull" --version

cd "$scratch/solver-run"
output=$(../solver/solver)
echo "$output"
(($(wc -l <<<"$output") == 3)) || { echo "three slabs were expected"; exit 1; }
[[ -z $(ls) ]] || { echo "the solver wrote files: $(ls)"; exit 1; }

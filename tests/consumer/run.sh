#!/usr/bin/env bash
# Installs a build tree to a fresh prefix, then configures, builds and runs the consumer against it.
# Usage: run.sh <build tree> <source of the consumer> <scratch directory>
set -euo pipefail
build=$1 source=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null
cmake -S "$source" -B "$scratch/build" -G Ninja -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$scratch/build"
cd "$scratch"
build/consumer
prefix/bin/slabhull --version

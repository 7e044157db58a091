#!/usr/bin/env bash
# Runs all benches and the study: bench/run.sh [FOLDER [LEVELS]]
# FOLDER (build/bench-results) gets the machine, a file per bench and the study's tables; LEVELS (1-5) are the study's. The figures of
# bench/RESULTS.md are from here. For an idle machine.
set -euo pipefail
cd "$(dirname "$0")/.."

out=${1:-build/bench-results}
levels=${2:-1-5}
mkdir -p "$out/soups"
scripts/build.sh bench

{
    date -u +%F
    git describe --always --dirty
    lscpu | grep -E '^(Model name|CPU\(s\)|Hypervisor vendor)'
    free -h | sed -n 2p
    g++ --version | head -1
    dpkg-query -W libtet1.5-dev libgmsh-dev libvtk9-dev petsc-dev libcgal-dev python3-meshio 2>/dev/null || true
} >"$out/machine.txt"

run() { # the bench and its options
    local name=$1
    shift
    echo "$name"
    "build/bench/bench/$name" "$@" >"$out/$name.txt" 2>&1 || echo "$name: exit $?" | tee -a "$out/failed.txt"
}

run bench_slab_check
run bench_slab_stages 7 3 "$out/stages"
run bench_slab_orders
run bench_slab_adapt 0.6 5 2
run bench_slab_fill 64 A
run bench_slab_partition 1
run bench_slab_fill 64 C
run bench_slab_stitch --benchmark_min_time=0.3
run bench_topology_matching --benchmark_min_time=0.2
run bench_geometry_cap_2d
run bench_geometry_cap_3d
run bench_geometry_cap_motion
run bench_geometry_mesh_order --benchmark_min_time=1
run bench_geometry_trajectories
run bench_topology_adjacency --soups="$out/soups"
run bench_io_files --soups="$out/soups"
build/bench/tools/slabhull study all --levels "$levels" --out "$out/study"
bench/study_table.py "$out/study/study.json" >"$out/study/tables.md"
[[ ! -s $out/failed.txt ]]

#!/usr/bin/env bash
# Fuzzes a reader: scripts/fuzz.sh READER MINUTES [options of libFuzzer]
# Keeps in tests/fuzz/found/READER what of all that was found adds coverage: scripts/fuzz.sh --merge READER
# Needs the build `cmake --preset fuzz && cmake --build --preset fuzz`. Files found go to build/fuzz/found/READER, crashes
# to build/fuzz/crashes/READER: fix them, and move them to tests/fuzz/regressions/READER.
set -euo pipefail
cd "$(dirname "$0")/.."

build=build/fuzz
data=tests/fuzz
folder=$(mktemp -d /dev/shm/slabhull-fuzz-XXXXXX) # of the files that the reader opens
trap 'rm -rf "$folder"' EXIT
export SLABHULL_FUZZ_FOLDER=$folder
export ASAN_OPTIONS=${ASAN_OPTIONS:-quarantine_size_mb=16}

# Memory and CPU time are checked by the fuzzer itself; the limits are a net below.
limits=(-max_len=8192 -timeout=180 -report_slow_units=180 -rss_limit_mb=1024 -malloc_limit_mb=128)

fuzz() {
    local reader=$1 seconds=$((60 * $2)) found=$build/found/$1 crashes=$build/crashes/$1 log=$build/logs/$1.log
    local given=("$data/corpus/$reader")
    local more
    for more in "$data/found/$reader" "$data/regressions/$reader"; do
        [[ -d $more ]] && given+=("$more")
    done
    mkdir -p "$found" "$crashes" "$build/logs"
    local dictionary=()
    [[ -f $data/dictionaries/$reader.dict ]] && dictionary=(-dict="$data/dictionaries/$reader.dict")
    local status=0
    { time "$build/tests/fuzz/fuzz_$reader" "${limits[@]}" "${dictionary[@]}" -max_total_time="$seconds" \
        -print_final_stats=1 "${@:3}" -artifact_prefix="$crashes/" "$found" "${given[@]}"; } >"$log" 2>&1 || status=$?
    echo "$reader: exit $status, $(grep -o 'cov: [0-9]* ft: [0-9]* corp: [0-9/KMb]*' "$log" | tail -1)," \
        "$(grep number_of_executed_units "$log" | grep -o '[0-9]*$') runs," $(grep '^user\|^sys' "$log") \
        "$(find "$crashes" -type f | wc -l) in $crashes"
    return "$status"
}

# Of all files found those that reach code which the seeds do not.
merge() {
    local reader=$1 kept=$data/found/$1 new=$folder/new
    mkdir -p "$new" "$kept" "$build/found/$reader"
    cp "$data/corpus/$reader"/* "$new"
    "$build/tests/fuzz/fuzz_$reader" "${limits[@]}" -max_len=4096 -set_cover_merge=1 -use_counters=0 "$new" "$kept" \
        "$build/found/$reader" 2>&1 | tail -1
    rm -rf "$kept"
    for seed in "$data/corpus/$reader"/*; do
        rm "$new/$(basename "$seed")"
    done
    mv "$new" "$kept"
    du -sh --apparent-size "$kept"
}

if [[ ${1:-} == --merge ]]; then
    merge "$2"
else
    fuzz "$@"
fi

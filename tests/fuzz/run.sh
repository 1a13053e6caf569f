#!/usr/bin/env bash
# Fuzzes every parser for SECONDS of processor time each (60), one after the other, with address and
# undefined-behaviour sanitizers; needs clang.
# usage: tests/fuzz/run.sh [SECONDS] [TARGET...]
# New inputs lie in build/fuzz/corpus/TARGET, findings in build/fuzz/findings; what libFuzzer prints, in
# build/fuzz/TARGET.log.
# usage: tests/fuzz/run.sh --keep TARGET FILE...
# Adds inputs to those of tests/fuzz/corpus/TARGET.tar.gz, which every run begins with and fuzz_corpus_test
# replays.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

kept=build/fuzz/kept
unpack() { # TARGET: what is kept of it, into $kept/TARGET
    rm -rf "${kept:?}/$1"
    mkdir -p "$kept/$1"
    [[ ! -e tests/fuzz/corpus/$1.tar.gz ]] || tar -xzf "tests/fuzz/corpus/$1.tar.gz" -C "$kept"
}

if [[ ${1:-} == --keep ]]; then
    target=${2:?a target must follow}
    shift 2
    unpack "$target"
    for input in "$@"; do
        cp "$input" "$kept/$target/kept_$(sha1sum <"$input" | cut -c1-10)"
    done
    # The same inputs always give the same archive.
    tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX --format=ustar -C "$kept" -cf - "$target" |
        gzip -9n >"tests/fuzz/corpus/$target.tar.gz"
    exit
fi

seconds=${1:-60}
shift || true
targets=("$@")
((${#targets[@]} > 0)) || targets=(scene ply spz spz_bare convert ksplat gltf sog_meta lod_meta sog_bundle settings headset cameras motion script)

[[ -e build/fuzz/build.ninja ]] ||
    cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo -DBINOSPLAT_FUZZ=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
cmake --build build/fuzz --target "${targets[@]/#/fuzz_}" --parallel 2

mkdir -p build/fuzz/findings
failed=0
TIMEFORMAT='%U %S'
for target in "${targets[@]}"; do
    unpack "$target"
    mkdir -p "build/fuzz/corpus/$target"
    # Processor time; libFuzzer itself stops by the wall clock, so a round on a busy machine is followed by
    # another.
    spent=0
    while ((spent < seconds)); do
        if ! { time ASAN_OPTIONS=allocator_may_return_null=1 build/fuzz/bin/fuzz_"$target" -max_total_time=$((seconds - spent)) -rss_limit_mb=2048 \
            -malloc_limit_mb=1024 -timeout=10 -max_len=8192 -print_final_stats=1 -artifact_prefix=build/fuzz/findings/"$target"- \
            "build/fuzz/corpus/$target" "$kept/$target" 2>"build/fuzz/$target.log"; } 2>"build/fuzz/$target.time"; then
            echo "$target: a finding, see build/fuzz/$target.log"
            failed=1
            break
        fi
        spent=$((spent + $(awk '{ print int($1 + $2 + 1) }' "build/fuzz/$target.time")))
        echo "$target: $spent s of processor time, $(grep -E '^#[0-9]+.*(DONE|cov:)' "build/fuzz/$target.log" | tail -1)"
    done
done
exit "$failed"

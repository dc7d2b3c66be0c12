#!/bin/sh
# Fuzzes what reads files and messages, each target for so many seconds (60), from the kept corpus and what earlier runs have
# found: tests/fuzz.sh [SECONDS] [TARGET...]. A night's run is tests/fuzz.sh 3600. Targets run side by side, one a processor. An input
# that crashes, hangs for ten seconds or takes more than 2 GB is a failure, and is left in build/fuzz/found/TARGET.
#
# tests/fuzz.sh --keep makes the kept corpus (tests/fuzz/corpus.tar.xz) anew: the smallest inputs that reach all that is reached.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh clang-14 libclang-rt-14-dev xz-utils
[ "${1:-}" = --keep ] && keep=1 && shift || keep=
seconds=${1:-60}
[ $# -gt 0 ] && shift
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz
cmake --build --preset fuzz
fuzzer=$PWD/build/fuzz/tests/lightwalk_fuzz
all=$(LIGHTWALK_FUZZ_TARGET= "$fuzzer" 2>&1 | sed -n 's/.*expected one of//p')
[ $# -gt 0 ] || set -- $all
mkdir -p build/fuzz/corpus build/fuzz/found
tar -xJf tests/fuzz/corpus.tar.xz -C build/fuzz/corpus
for target in $all; do
    mkdir -p "build/fuzz/corpus/$target" "build/fuzz/found/$target"
    LIGHTWALK_FUZZ_TARGET=$target LIGHTWALK_FUZZ_SEEDS=$PWD/build/fuzz/corpus/$target "$fuzzer"
done
export fuzzer seconds
export ASAN_OPTIONS=detect_leaks=0:handle_sigill=1 # leaks are looked for by the tests; here each input would take twice as long
if [ -n "$keep" ]; then
    rm -rf build/fuzz/kept
    for target in $all; do
        mkdir -p "build/fuzz/kept/$target"
        LIGHTWALK_FUZZ_TARGET=$target "$fuzzer" -merge=1 -timeout=10 -max_len=4096 "build/fuzz/kept/$target" "build/fuzz/corpus/$target" 2>&1 | tail -1
    done
    tar -cJf tests/fuzz/corpus.tar.xz --sort=name --owner=0 --group=0 --mtime=@0 -C build/fuzz/kept .
    exit
fi
printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} sh -c '
    status=0
    LIGHTWALK_FUZZ_TARGET={} "$fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 \
        -artifact_prefix=build/fuzz/found/{}/ build/fuzz/corpus/{} > build/fuzz/found/{}.log 2>&1 || status=$?
    runs=$(sed -n "s/^stat::number_of_executed_units: *//p" build/fuzz/found/{}.log)
    if [ $status -eq 0 ]; then echo "{}: $runs inputs, $(ls build/fuzz/corpus/{} | wc -l) kept"
    else echo "{}: FAILED, see build/fuzz/found/{}.log"; exit 1; fi'

#!/bin/sh
# What two cores cannot do within CI's time: every call to the system and every allocation that can fail, by every error; 100,000
# seeds of the simulation; each fuzz target for so many seconds (60); which lines and branches the tests reach, with the shares that
# are promised: tests/night.sh [SECONDS]. All of it runs whatever fails; a line for each stage comes last, and 1 where one has failed.
# What the stages say is in build/night. On two cores about an hour.
set -u
cd "$(dirname "$0")/.." || exit
seconds=${1:-60}
mkdir -p build/night
sh apps/install_packages.sh strace
cmake --preset release && cmake --build --preset release || exit
lightwalk=$PWD/build/release/lightwalk tests=$PWD/build/release/tests faults=$PWD/tests/faults
summary=""
stage() {
    name=$1 start=$(date +%s) verdict=passes
    shift
    echo "$name: $*"
    "$@" >"build/night/$name.log" 2>&1 || verdict=FAILED
    summary="$summary$(printf '%4d min  %-22s %s' $((($(date +%s) - start) / 60)) "$name" "$verdict")
"
    [ $verdict = passes ] || tail -n 20 "build/night/$name.log"
}
# Those that ctest runs by the likeliest errors.
cases() { ctest --test-dir build/release -N -R "^faults-($1)" | sed -n 's/^ *Test .*: faults-//p'; }
# Side by side, one a processor: each of the words in the place of {}.
each() {
    [ -n "$1" ] || return 1 # nothing to run is nothing that passes
    printf '%s\n' "$1" >build/night/cases
    shift
    xargs -a build/night/cases -P "$(nproc)" -I{} "$@"
}
stage calls each "$(cases '' | grep -v -e ^allocations- -e '^launch$')" \
    /usr/bin/python3 "$faults/failing_calls_test.py" "$lightwalk" {} all
stage calls-of-launch /usr/bin/python3 "$faults/failing_launch_test.py" "$lightwalk" all
stage allocations each "$(cases allocations- | sed 's/^allocations-//')" "$tests/failing_allocations" {} all
stage simulation each "pictures*
walks*" env LIGHTWALK_SEEDS=100000 "$tests/lightwalk_tests" "-tc=simulation: {}"
stage fuzz sh tests/fuzz.sh "$seconds"
stage coverage sh tests/coverage.sh
printf '%s' "$summary"
case "$summary" in *FAILED*) exit 1 ;; esac

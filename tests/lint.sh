#!/bin/sh
# What no test can see: every file as .clang-format says, then clang-tidy's checks that find bugs, on all that is
# shipped (.clang-tidy has more of them, for editors; tests/ and perf/ would take as long again). Warnings are
# errors. Files are looked at by the eight where they can be, as their headers take most of the time.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh clang-format-14 clang-tidy-14
git ls-files '*.cpp' '*.h' | xargs -P "$(nproc)" -n 100 clang-format-14 --dry-run -Werror

build=build/lint
cmake --preset asan -B "$build" -DLIGHTWALK_UNITY=ON -DLIGHTWALK_TESTS=OFF >/dev/null
cmake --build "$build" --target viewer_pages >/dev/null  # a source that the build writes
# Left out of bugprone-* and performance-*: what speaks up at sound code (rows of a .def file expand to equal branches),
# and what takes a third of the time for what the compiler's warnings cover (empty statements, reserved names); and
# clang-analyzer-*, two thirds of the rest, which found nothing that the sanitizers do not.
checks='-*,bugprone-*,-bugprone-easily-swappable-parameters,-bugprone-narrowing-conversions'
checks="$checks,-bugprone-reserved-identifier,-bugprone-stringview-nullptr,-bugprone-suspicious-string-compare"
checks="$checks,-bugprone-branch-clone,-bugprone-undelegated-constructor,-bugprone-multiple-statement-macro"
checks="$checks,-bugprone-suspicious-semicolon,-bugprone-suspicious-include"
checks="$checks,concurrency-mt-unsafe,cert-err34-c"
checks="$checks,cppcoreguidelines-slicing,misc-definitions-in-headers"
checks="$checks,performance-*,-performance-inefficient-string-concatenation"
# Standard error holds counts of warnings in system headers, which are not shown, and what stops clang-tidy itself.
python3 -c 'import json, sys; print(*(entry["file"] for entry in json.load(open(sys.argv[1]))), sep="\n")' \
    "$build/compile_commands.json" | grep -v -e verify_interface -e openimageio |
    xargs -P "$(nproc)" -n 1 clang-tidy-14 -p "$build" --quiet --warnings-as-errors='*' \
        --checks="$checks" 2>"$build/clang-tidy.log" ||
    { grep -v 'warnings generated' "$build/clang-tidy.log" >&2; exit 1; }

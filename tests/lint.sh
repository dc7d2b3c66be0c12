#!/bin/sh
# What no test can see: every file as .clang-format says, then clang-tidy's checks that find bugs, on all that is
# shipped (.clang-tidy has more of them, for editors; tests/ and perf/ would take as long again). Warnings are
# errors. An argument names the preset whose compile commands are used: one with assertions, which the analyzer believes.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh clang-format-14 clang-tidy-14
git ls-files '*.cpp' '*.h' | xargs clang-format-14 --dry-run -Werror

preset="${1:-asan}"
cmake --preset "$preset" >/dev/null
# Left out of bugprone-* and performance-*: what speaks up at sound code (rows of a .def file expand to equal branches),
# and what takes a third of the time for what the compiler's warnings cover (empty statements, reserved names); and
# clang-analyzer-*, two thirds of the rest, which found nothing that the sanitizers do not.
checks='-*,bugprone-*,-bugprone-easily-swappable-parameters,-bugprone-narrowing-conversions'
checks="$checks,-bugprone-reserved-identifier,-bugprone-stringview-nullptr,-bugprone-suspicious-string-compare"
checks="$checks,-bugprone-branch-clone,-bugprone-undelegated-constructor,-bugprone-multiple-statement-macro"
checks="$checks,-bugprone-suspicious-semicolon"
checks="$checks,concurrency-mt-unsafe,cert-err34-c"
checks="$checks,cppcoreguidelines-slicing,misc-definitions-in-headers"
checks="$checks,performance-*,-performance-inefficient-string-concatenation"
# Standard error holds counts of warnings in system headers, which are not shown, and what stops clang-tidy itself.
git ls-files 'core/*.cpp' 'parallel/*.cpp' 'io/*.cpp' 'apps/*.cpp' |
    xargs -P "$(nproc)" -n 1 clang-tidy-14 -p "build/$preset" --quiet --warnings-as-errors='*' \
        --checks="$checks" 2>"build/$preset/clang-tidy.log" ||
    { grep -v 'warnings generated' "build/$preset/clang-tidy.log" >&2; exit 1; }

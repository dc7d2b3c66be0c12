#!/bin/sh
# Which lines and branches of core, parallel and io their tests reach: builds the preset `coverage`, runs the unit tests of these
# folders and the reference's small cases, prints a table by folder, and ends with 1 where less is reached than is promised:
# 95 % of the lines and 85 % of the branches of core, 90 % of the lines of parallel and io. On two cores about a quarter of an hour.
#
# Branches that only an exception takes are left out: each call that may throw has one. Nothing is inlined before it is counted
# (-fno-early-inlining): a condition has two branches, not two wherever it was copied to. Words are ctest's, in place of these tests;
# tests that let calls to the system fail (faults-*) would spoil the counts, which are written by such calls.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh gcovr
cmake --preset coverage
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
[ $# -gt 0 ] || set -- -R '^tests/(core|parallel|io)/|^reference-(cases|rays|bsdf_cases|ambient_cases)$'
ctest --preset coverage -j "$(($(nproc) + 1))" "$@" || echo "some tests failed: what they reached counts"
gcovr --root . --object-directory build/coverage --filter 'core/' --filter 'parallel/' --filter 'io/' --filter 'apps/' \
    --exclude-throw-branches --exclude-unreachable-branches --gcov-ignore-parse-errors -j "$(nproc)" \
    --json-summary build/coverage/summary.json >/dev/null
python3 - <<'END'
import collections, json, pathlib, sys
PROMISED = {"core": (95, 85), "parallel": (90, 0), "io": (90, 0)}  # of lines and branches [%]
counts = collections.defaultdict(lambda: [0] * 4)
for file in json.load(open("build/coverage/summary.json"))["files"]:
    path = pathlib.Path(file["filename"])
    for name in {path.parts[0], str(path.parent)}:
        for k, key in enumerate(("line_covered", "line_total", "branch_covered", "branch_total")):
            counts[name][k] += file[key]
percent = lambda part, whole: 100 * part / whole if whole else 100
print(f"{'folder':24} {'lines':>16} {'branches':>18}")
for name, (lines, all_lines, branches, all_branches) in sorted(counts.items()):
    print(f"{name:24} {lines:7} {percent(lines, all_lines):5.1f} % {branches:11} {percent(branches, all_branches):5.1f} %")
short = [f"{name}: less than {goal} % of the {what}" for name, goals in PROMISED.items() for k, (goal, what) in enumerate(zip(goals, ("lines", "branches")))
         if percent(*counts[name][2 * k:2 * k + 2]) < goal]
sys.exit("\n".join(short) or None)
END

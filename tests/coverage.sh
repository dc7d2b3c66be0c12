#!/bin/sh
# Which lines and branches the tests reach, by folder: builds the preset `coverage`, runs the unit tests and those against
# reference data, and prints a table. Branches that only an exception takes are left out: each call that may throw has one.
# Words are ctest's, in place of all tests but the benchmarks', the packages', the browser's, and those that let calls to the system
# fail: among these are the calls that add to the counts, which are spoiled then.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh gcovr strace
cmake --preset coverage
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
[ $# -gt 0 ] || set -- -LE 'perf|package|python' -E 'viewer-|perf-|old-processors|faults-'
ctest --preset coverage -j "$(($(nproc) + 1))" "$@" || echo "some tests failed: what they reached counts"
gcovr --root . --object-directory build/coverage --filter 'core/' --filter 'parallel/' --filter 'io/' --filter 'apps/' \
    --exclude-throw-branches --exclude-unreachable-branches --gcov-ignore-parse-errors -j "$(nproc)" \
    --json-summary build/coverage/summary.json >/dev/null
python3 - <<'END'
import collections, json, pathlib
counts = collections.defaultdict(lambda: [0] * 4)
for file in json.load(open("build/coverage/summary.json"))["files"]:
    path = pathlib.Path(file["filename"])
    for name in {path.parts[0], str(path.parent)}:
        for k, key in enumerate(("line_covered", "line_total", "branch_covered", "branch_total")):
            counts[name][k] += file[key]
print(f"{'folder':24} {'lines':>16} {'branches':>18}")
for name, (lines, all_lines, branches, all_branches) in sorted(counts.items()):
    share = lambda a, b: f"{a:7} {100 * a / b if b else 100:5.1f} %"
    print(f"{name:24} {share(lines, all_lines)} {share(branches, all_branches):>18}")
END

#!/bin/sh
# Install what is needed, build, and run all tests. An argument names another preset (asan, tsan); more arguments
# go to ctest. --no-browser, before them: without the test of the page in a browser, which is large to install.
set -eu
cd "$(dirname "$0")/.."
browser=chromium
if [ "${1:-}" = --no-browser ]; then
    browser=""
    shift
fi
preset="${1:-release}"
[ $# -eq 0 ] || shift
[ "$preset" = release ] || browser=""  # a browser is not what sanitizers look at
# Node.js may be there from elsewhere.
if [ -n "$browser" ]; then
    command -v node >/dev/null || browser="$browser nodejs"
    command -v npm >/dev/null || browser="$browser npm"
fi
# shellcheck disable=SC2086  # a list of words
sh apps/install_packages.sh qemu-user pybind11-dev python3-dev python3-pip python3-pytest dpkg-dev file strace $browser
if [ -n "$browser" ] && [ ! -d build/npm/node_modules/jpeg-js ]; then
    mkdir -p build/npm
    npm install --silent --no-audit --no-fund --prefix build/npm playwright-core@1 axe-core@4 ws@8 jpeg-js@0.4
fi
cmake --preset "$preset"
cmake --build --preset "$preset"
status=0
# More than there are cores, since some tests wait for most of their time; without a browser, which needs the cores, two more.
jobs=$(($(nproc) + 2))
[ "$preset" != release ] || jobs=$(($(nproc) + 1))
ctest --preset "$preset" -j "$jobs" -O "build/$preset/ctest.log" "$@" || status=$?
if [ "$status" -ne 0 ]; then
    # What failed once more, where those who see only the end of a long log find it; then ctest's summary again.
    awk '/^[0-9]+\/[0-9]+ Testing: / { block = "" } { block = block $0 "\n" } /^Test Failed/ { print block }' \
        "build/$preset/Testing/Temporary/LastTest.log" | cut -c1-300 | tail -n 60
    sed -n '/tests passed,/,$p' "build/$preset/ctest.log"
fi
exit "$status"

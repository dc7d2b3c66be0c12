#!/bin/sh
# Install what is needed, build, and run all tests. An argument names another preset (asan, tsan); more arguments
# go to ctest.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh qemu-user
preset="${1:-release}"
[ $# -eq 0 ] || shift
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)" "$@"

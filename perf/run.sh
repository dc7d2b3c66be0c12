#!/bin/sh
# Measure how Lightwalk scales over ranks and threads, and what walks reuse. Writes JSON and SVG into a folder.
# Usage: perf/run.sh NAME [--scenes DIR] [--lightwalk PROGRAM] [--out DIR] [--size N] [--runs N] [--cores N] [--frames N]
# NAME: table1, splits, speedup, stride, ambient-exchange, accuracy, model, same-bytes, kills, many-ranks, walk-model, table2, walkfilm, walk, changes,
# scene, bsdf, ablation;
# README.md beside this file tells what they are.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
# As root mpirun wants to be told twice that this is meant.
if [ "$(id -u)" -eq 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
export PMIX_MCA_gds=hash  # no memory shared with mpirun, whose lock a killed rank might hold
case " $* " in
*" --lightwalk "* | *" --lightwalk="* | *" --help "* | *" -h "*) ;;
*)
    cmake --preset release -S "$root" >/dev/null
    cmake --build "$root/build/release" --target lightwalk lightwalk_mpi scaling_model walk_model cost_map message_bench
    ;;
esac
# The system's Python, whatever else stands first on the PATH.
python=/usr/bin/python3
[ -x "$python" ] || python=python3
case "${1:-}" in
walk) script=live_walk.py ;;
changes) script=live_changes.py ;;
scene) script=scene_bench.py ;;
bsdf) script=bsdf_bench.py ;;
ablation) script=ablation.py ;;
*) exec "$python" "$root/perf/scaling/measure.py" "$@" ;;
esac
shift
exec "$python" "$root/perf/$script" "$@"

#!/usr/bin/python3
"""Measures how Lightwalk scales over ranks and threads, and how much walks reuse; started by perf/run.sh."""
import argparse, os, pathlib, sys

import checks
import experiments
import model
import variants
import walk_model
import walks
from runs import ROOT, Program, find_scene

NAMES = {"table1": experiments.table1, "splits": experiments.splits, "speedup": variants.speedup, "stride": experiments.stride,
         "ambient-exchange": experiments.ambient_exchange, "accuracy": variants.accuracy, "model": model.run,
         "walk-model": walk_model.run, "table2": walks.table2, "walkfilm": walks.walkfilm, "same-bytes": checks.same_bytes,
         "kills": checks.kills, "many-ranks": checks.many_ranks}


def main():
    parser = argparse.ArgumentParser(prog="perf/run.sh", description=__doc__)
    parser.add_argument("name", choices=NAMES)
    parser.add_argument("--scenes", type=pathlib.Path, metavar="DIR",
                        help="folder of Radiance's sample models (default: the one beside the project, else the demo scene)")
    parser.add_argument("--lightwalk", default=ROOT / "build/release/lightwalk", metavar="PROGRAM")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/perf", metavar="DIR")
    parser.add_argument("--size", type=int, default=480, metavar="N", help="width of pictures [pixels]")
    parser.add_argument("--runs", type=int, default=5, metavar="N", help="of each, of which the median counts")
    parser.add_argument("--cores", type=int, default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--frames", type=int, default=50, metavar="N", help="table2, walkfilm: of a walk")
    parser.add_argument("--truth", type=int, default=256, metavar="N",
                        help="accuracy: ambient rays a point of the picture that the others are held against")
    parser.add_argument("--predict-only", action="store_true",
                        help="model: with the cost maps and figures that an earlier run left in the folder")
    options = parser.parse_args()
    if options.size < 16 or min(options.runs, options.cores, options.truth) < 1 or options.frames < 2:
        parser.error("--size is at least 16, --frames 2, --runs, --cores and --truth 1")
    if not pathlib.Path(options.lightwalk).is_file():
        parser.error(f"there is no program {options.lightwalk}")
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    result = NAMES[options.name](Program(options.lightwalk, find_scene(options.scenes)), options)
    if result is False:
        print(f"{options.name}: not all of it holds", file=sys.stderr)
    return 1 if result is False else 0


if __name__ == "__main__":
    sys.exit(main())

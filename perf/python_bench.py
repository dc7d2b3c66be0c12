#!/usr/bin/env python3
"""What Python costs: whole runs and single rays, by the package and by the program that it holds, in turn.

    python perf/python_bench.py [--size N] [--rays N] [--runs N] [--threads N]      with the Python where the package is installed

Prints, as medians of the runs:
  whole   a picture of the demo scene, from the start of the process to its end
  rays    a million rays: Scene.trace from arrays to an array, and the program on the same rays as doubles, less what it
          takes without any
each as time that passes, and as processor time, which tells more where the machine does other things as well."""
import argparse, os, pathlib, statistics, subprocess, sys, tempfile, time

import numpy as np

import lightwalk

VIEW = lightwalk.demo_views()["living"]
PROGRAM = pathlib.Path(lightwalk.__file__).parent / "bin" / "lightwalk"
WHOLE = """import lightwalk, sys
view, file, size, threads = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
scene = lightwalk.demo_scene()
lightwalk.save_picture(file, scene.render(view, size, n=threads))
"""


def run_of(words, rays=os.devnull):
    """Seconds of a process, and its processor time."""
    before, start = os.times(), time.perf_counter()
    with open(rays, "rb") as file:
        subprocess.run([*map(str, words)], stdin=file, check=True, stdout=subprocess.DEVNULL)
    seconds, after = time.perf_counter() - start, os.times()
    return seconds, after.children_user + after.children_system - before.children_user - before.children_system


def cost_of(work):
    """The same of a call."""
    start, processor = time.perf_counter(), time.process_time()
    work()
    return time.perf_counter() - start, time.process_time() - processor


def report(name, python, program):
    a, b = statistics.median(python), statistics.median(program)
    print(f"{name:22} Python {a:8.3f} s   program {b:8.3f} s   {100 * (a / b - 1):+5.1f} %", flush=True)


def main():
    parser = argparse.ArgumentParser()
    for name, default in (("size", 768), ("rays", 1_000_000), ("runs", 5), ("threads", os.cpu_count())):
        parser.add_argument("--" + name, type=int, default=default)
    options = parser.parse_args()
    os.chdir(VIEW.parent.parent)  # where the scene's files look for each other
    scene_files = ["lodge.rad", "day.rad"]
    common = ["-n", str(options.threads), *scene_files]
    picture = ["-vf", str(VIEW), "-x", str(options.size), "-y", str(options.size)]
    scene = lightwalk.demo_scene().load()
    rng = np.random.default_rng(0)
    origins, directions = np.tile([5., 3.5, 1.6], (options.rays, 1)), rng.normal(size=(options.rays, 3))
    results = {}

    def note(name, kind, cost, start=(0, 0)):
        for what, value, less in zip(("", ", processor"), cost, start):
            results.setdefault((name + what, kind), []).append(value - less)

    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "rays").write_bytes(np.hstack([origins, directions]).tobytes())
        tracing = [PROGRAM, "trace", "-h-", "-fdf", *common]
        for _ in range(options.runs):
            note("whole", "python", run_of([sys.executable, "-c", WHOLE, VIEW, folder / "p.hdr", options.size, options.threads]))
            note("whole", "program", run_of([PROGRAM, "render", *picture, "-o", folder / "c.hdr", "--quiet", *common]))
            note("rays", "python", cost_of(lambda: scene.trace(origins, directions, n=options.threads)))
            start = run_of(tracing)  # of no rays: reading the scene
            note("rays", "program", run_of(tracing, folder / "rays"), start)
    for name, kind in results:
        if kind == "python":
            report(name, results[name, "python"], results[name, "program"])


main()

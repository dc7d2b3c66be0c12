#!/usr/bin/env python3
"""What Python costs: whole runs and single rays, by the package and by the program that it holds, in turn.

    python perf/python_bench.py [--size N] [--rays N] [--runs N] [--threads N]      with the Python where the package is installed

Prints, as medians of the runs:
  whole   a picture of the demo scene, from the start of the process to its end, and the processor time of it
  render  the picture alone: Scene.render, and the program's --stats
  rays    a million rays: Scene.trace from arrays to an array, and the program's --stats of the same rays as doubles"""
import argparse, json, os, pathlib, statistics, subprocess, sys, tempfile, time

import numpy as np

import lightwalk

VIEW = lightwalk.demo_views()["living"]
PROGRAM = pathlib.Path(lightwalk.__file__).parent / "bin" / "lightwalk"
WHOLE = """import lightwalk, sys
view, file, size, threads = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
scene = lightwalk.demo_scene()
lightwalk.save_picture(file, scene.render(view, size, n=threads))
"""


def run_of(words):
    """Seconds of a process, and its processor time."""
    before, start = os.times(), time.perf_counter()
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    seconds, after = time.perf_counter() - start, os.times()
    return seconds, after.children_user + after.children_system - before.children_user - before.children_system


def seconds_of(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def stats_seconds(words, folder, input=None):
    """What the program says of its own work, without reading the scene."""
    stats = folder / "stats.json"
    with open(input or os.devnull, "rb") as rays:
        subprocess.run([*words, "--stats", stats, "--quiet"], stdin=rays, check=True, stdout=subprocess.DEVNULL)
    return json.loads(stats.read_text())["seconds"]["render"]


def report(name, unit, python, program):
    a, b = statistics.median(python), statistics.median(program)
    print(f"{name:22} Python {a:9.4g} {unit}   program {b:9.4g} {unit}   {100 * (a / b - 1):+5.1f} %", flush=True)


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
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "rays").write_bytes(np.hstack([origins, directions]).tobytes())
        for _ in range(options.runs):
            for kind, words in (("python", [sys.executable, "-c", WHOLE, VIEW, folder / "p.hdr", str(options.size), str(options.threads)]),
                                ("program", [PROGRAM, "render", *picture, "-o", folder / "c.hdr", "--quiet", *common])):
                whole, processor = run_of(words)
                results.setdefault(("whole", "s", kind), []).append(whole)
                results.setdefault(("whole, processor", "s", kind), []).append(processor)
            results.setdefault(("render", "s", "python"), []).append(seconds_of(lambda: scene.render(str(VIEW), options.size, n=options.threads)))
            results.setdefault(("render", "s", "program"), []).append(stats_seconds([PROGRAM, "render", *picture, "-o", folder / "c.hdr", *common], folder))
            results.setdefault(("rays", "s", "python"), []).append(seconds_of(lambda: scene.trace(origins, directions, n=options.threads)))
            results.setdefault(("rays", "s", "program"), []).append(stats_seconds([PROGRAM, "trace", "-h-", "-fdf", *common], folder, folder / "rays"))
    for name, unit, kind in results:
        if kind == "python":
            report(name, unit, results[name, unit, "python"], results[name, unit, "program"])


main()

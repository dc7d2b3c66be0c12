#!/usr/bin/python3
"""Error against time of pictures of several rays a pixel: `lightwalk render --samples` beside rpict at twice and three times the size with
pfilt; needs python3-numpy.

  quality_bench.py --radiance DIR [--scenes DIR] [--lightwalk PROGRAM] [--views NAME,...] [--samples 4,9,16] [--larger 2,3]
                   [--size 320x240] [--converged 16] [--runs 1] [--keep DIR] [--options "WORDS"]

--radiance holds Radiance's oconv, rpict and pfilt (without it Lightwalk stands alone), --scenes its sample models: DIR/cabin and DIR/lib. Views are
the cabin by day (living, interior) and by night, the demo scene (lodge, lodge-evening), and an office of 64 lamps: direct light alone, -dj .7. Both filter
with the Gaussian exp(-(r / .6)^2), r in pixels, which pfilt -r .6 ends at 1.3 pixels (seen in what it makes of a single bright pixel). The error is the mean of
|L - R| / R over pixels; R is the mean of two converged pictures, so that nobody is judged by noise of his own: rpict's at --converged times
the size with pfilt, and Lightwalk's of as many rays (another seed). --keep is a folder where they are kept for the next time. --options are more words for lightwalk.

One line a picture, tab-separated: view, program, rays a pixel, error, processor seconds of whole processes on one thread (median
of --runs; rpict with pfilt, without oconv). Then for each of rpict's pictures how many times as fast Lightwalk is at its error, by interpolation
between logarithms ("<" and ">": beyond what was measured, by the nearest two).
"""
import argparse, math, os, pathlib, resource, statistics, subprocess, sys, tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import office
from walk import pictures

CABIN = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad"
SUMMER = f"{CABIN} summerday landscape lights.off daywindows"
VIEWS = {  # folder, view, files
    "living": ("cabin", "vf/living", SUMMER),
    "interior": ("cabin", "vf/interior", SUMMER),
    "night": ("cabin", "vf/living2", f"{CABIN} lights"),
    "lodge": ("lodge", "views/living.vf", "lodge.rad day.rad"),
    "lodge-evening": ("lodge", "views/living.vf", "lodge.rad night.rad"),
    "office": ("office", "office.vf", "office.rad"),
}
OPTIONS = "-pa 0 -ps 1 -dj .7 -ab 0 -av .01 .01 .01".split()
RADIUS = ".6"


def make_office(folder):
    """64 lamps in one room."""
    folder.mkdir()
    (folder / "office.rad").write_text(office.office())
    (folder / "office.vf").write_text("rvu -vtv " + " ".join(office.VIEW) + "\n")
    return str(folder)


class Bench:
    def __init__(self, arguments, name, scratch):
        place, self.view, words = VIEWS[name]
        self.arguments, self.name, self.scratch, self.words = arguments, name, pathlib.Path(scratch), words.split()
        self.folder = (os.path.join(arguments.scenes or "", "cabin") if place == "cabin"
                       else str(HERE.parent / "apps/scenes/lodge") if place == "lodge" else make_office(self.scratch / place))
        self.environment = dict(os.environ, RAYPATH=os.pathsep.join([".", "../lib", arguments.library or "."]))
        self.keep = pathlib.Path(arguments.keep or scratch)
        if arguments.radiance:
            self.environment["PATH"] = os.path.abspath(arguments.radiance) + os.pathsep + os.environ["PATH"]
            self.octree = self.scratch / f"{name}.oct"
            with open(self.octree, "wb") as out:
                subprocess.run(["oconv", "-w", *self.words], cwd=self.folder, env=self.environment, stdout=out, check=True)

    def processor_seconds(self, command, out):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(out, "wb") as file:
            done = subprocess.run(command, cwd=self.folder, env=self.environment, stdout=file, stderr=subprocess.PIPE)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}: {done.stderr.decode(errors='replace')[-500:]}")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def lightwalk(self, samples, out, seed=1):
        width, height = self.arguments.size
        return self.processor_seconds(
            [self.arguments.lightwalk, "render", "--quiet", "-n", "1", "--seed", str(seed), "-vf", self.view, *OPTIONS, "-x", str(width),
             "-y", str(height), "--samples", str(samples), *self.arguments.options, *self.words], out)

    def rpict(self, larger, out):
        width, height = self.arguments.size
        big = self.scratch / "big.hdr"
        seconds = self.processor_seconds(["rpict", "-vf", self.view, *OPTIONS, "-x", str(width * larger), "-y", str(height * larger),
                                          str(self.octree)], big)
        return seconds + self.processor_seconds(
            ["pfilt", "-1", "-e", "1", "-x", f"/{larger}", "-y", f"/{larger}", "-r", RADIUS, str(big)], out)

    def converged(self):
        larger = self.arguments.converged
        made = []
        for program, make in (("lightwalk", lambda out: self.lightwalk(larger ** 2, out, seed=77)), ("rpict", lambda out: self.rpict(larger, out))):
            if program == "rpict" and not self.arguments.radiance:
                continue
            path = self.keep / f"{self.name}-{program}-{larger}-{'x'.join(map(str, self.arguments.size))}.hdr"
            if not path.exists():
                make(path)
            made.append(luminance(path))
        return np.mean(made, axis=0)

    def pictures(self):
        """Program, rays a pixel, and how to make the picture."""
        ours = [("lightwalk", n, lambda out, n=n: self.lightwalk(n, out)) for n in self.arguments.samples]
        theirs = [("rpict", k * k, lambda out, k=k: self.rpict(k, out)) for k in self.arguments.larger if self.arguments.radiance]
        return theirs + ours


def luminance(path):
    return pictures.luminance(pictures.read_hdr(path))


def error(picture, truth):
    return float(np.mean(np.abs(picture - truth) / np.maximum(truth, 1e-3 * np.mean(truth))))


def seconds_at(wanted, found):
    """Seconds at an error, between the two nearest (error, seconds) by logarithms, and a mark where it lies beyond all."""
    points = sorted((math.log(e), math.log(s)) for e, s in found)
    x = math.log(wanted)
    mark = "<" if x > points[-1][0] else ">" if x < points[0][0] else ""
    if len(points) < 2:
        return math.exp(points[0][1]), "~"
    i = min(max(sum(p[0] < x for p in points), 1), len(points) - 1)
    (x0, y0), (x1, y1) = points[i - 1], points[i]
    return math.exp(y0 + (y1 - y0) * (x - x0) / (x1 - x0) if x1 > x0 else y0), mark


def measure(bench):
    truth = bench.converged()
    found = {}
    out = bench.scratch / "picture.hdr"
    every = bench.pictures()
    seconds = {(program, rays): [] for program, rays, _ in every}
    for _ in range(bench.arguments.runs):
        for program, rays, make in every:
            seconds[program, rays].append(make(out))
            found[program, rays] = error(luminance(out), truth)
    lines = {key: (found[key], statistics.median(seconds[key])) for key in found}
    for (program, rays), (e, s) in lines.items():
        print(bench.name, program, rays, f"{e:.4f}", f"{s:.2f}", sep="\t", flush=True)
    ours = [line for (program, _), line in lines.items() if program == "lightwalk"]
    for (program, rays), (e, s) in lines.items():
        if program == "rpict":
            at, mark = seconds_at(e, ours)
            print(bench.name, f"at the error of rpict's {rays}", f"{mark}{s / at:.1f} times as fast", sep="\t", flush=True)


def numbers(text):
    return [int(word) for word in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radiance")
    parser.add_argument("--library", help="Radiance's library of function files")
    parser.add_argument("--scenes")
    parser.add_argument("--lightwalk", default=str(HERE.parent / "build/release/lightwalk"))
    parser.add_argument("--views", type=lambda text: text.split(","), default=None)
    parser.add_argument("--samples", type=numbers, default=[4, 9, 16])
    parser.add_argument("--larger", type=numbers, default=[2, 3])
    parser.add_argument("--size", type=lambda text: [int(word) for word in text.split("x")], default=[320, 240])
    parser.add_argument("--converged", type=int, default=16)
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("--options", type=str.split, default=[])
    arguments = parser.parse_args()
    for name in ("lightwalk", "scenes", "radiance", "library"):
        path = getattr(arguments, name)
        setattr(arguments, name, os.path.abspath(path) if path and (name != "lightwalk" or os.sep in path) else path)
    names = arguments.views or [name for name, (place, *_) in VIEWS.items() if place != "cabin" or arguments.scenes]
    print("view\tprogram\trays a pixel\terror\tprocessor s", flush=True)
    for name in names:
        with tempfile.TemporaryDirectory() as scratch:
            measure(Bench(arguments, name, scratch))
    return 0


if __name__ == "__main__":
    sys.exit(main())

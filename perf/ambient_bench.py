#!/usr/bin/python3
"""Error against time of indirect light in the summer cabin; needs python3-numpy.

  ambient_bench.py --scenes DIR [--lightwalk PROGRAM] [--converged FILE.hdr] [--threads 1,2] [--bounces 1] [--runs 1]
                   [--accuracy A] [--size 320x240] [--rpict PROGRAM --octree FILE]

DIR holds Radiance's sample models: DIR/cabin and DIR/lib. FILE.hdr is the picture without cache (-aa 0) that the others are
compared with: for one bounce tests/reference/summer-living-converged.hdr. Where it is missing it is made, with --divisions hemisphere
samples (default 4096: ten minutes on two cores for one bounce). Without --converged only the time is measured.
--accuracy leaves one setting. With --rpict the same pictures by an installed Radiance stand beside, in turns: FILE is what its oconv
makes of the same words, which need its generators.
One line a picture, tab-separated: program, threads, -aa, -ad, seconds of the whole process, values in the cache, 95th percentile and
mean of the relative error of 4x4 blocks, mean ratio. One curve is the lines of one program and number of threads.
"""
import argparse, json, math, os, pathlib, statistics, subprocess, sys, tempfile, time

import numpy as np

SCENE = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad summerday landscape lights.off daywindows".split()
VIEW = ("-vf vf/living -ps 1 -pj 0 -dj 0 -ss 0 -dt 0 -aE ../lib/tree.mat -av .1 .1 .1").split()
SETTINGS = [(0.3, 128, 32, 64), (0.2, 256, 64, 96), (0.15, 512, 128, 128), (0.1, 1024, 256, 256)]  # -aa -ad -as -ar


def read_hdr(path):
    """Radiance picture, new run-length encoding: array of height, width, 3."""
    data = pathlib.Path(path).read_bytes()
    at = data.index(b"\n\n") + 2
    end = data.index(b"\n", at)
    words = data[at:end].split()
    height, width, at = int(words[1]), int(words[3]), end + 1
    rows = np.zeros((height, 4, width), np.uint8)
    for row in rows:
        at += 4
        for channel in row:
            filled = 0
            while filled < width:
                count = data[at]
                at += 1
                if count > 128:
                    channel[filled:filled + count - 128] = data[at]
                    count -= 128
                    at += 1
                else:
                    channel[filled:filled + count] = np.frombuffer(data, np.uint8, count, at)
                    at += count
                filled += count
    scale = np.where(rows[:, 3] > 0, np.exp2(rows[:, 3].astype(float) - 136), 0)
    return (rows[:, :3].astype(float).transpose(0, 2, 1) + 0.5) * scale[:, :, None]


def blocks(picture):
    height, width = picture.shape[0] // 4 * 4, picture.shape[1] // 4 * 4
    return picture[:height, :width].reshape(height // 4, 4, width // 4, 4, 3).mean((1, 3))


def compare(picture, reference):
    a, b = blocks(picture), blocks(reference)
    error = np.abs(a - b).max(2) / np.maximum(b.max(2), 0.02 * b.mean())
    return float(np.percentile(error, 95)), float(error.mean()), float(picture.mean() / reference.mean())


def run(arguments, command, **where):
    """Seconds of the whole process."""
    start = time.monotonic()
    subprocess.run(command, check=True, cwd=os.path.join(arguments.scenes, "cabin"),
                   env=dict(os.environ, RAYPATH=".:../lib:" + os.environ.get("RAYPATH", "")), **where)
    return time.monotonic() - start


def view_options(arguments, options):
    width, height = arguments.size.split("x")
    return [*VIEW, "-x", width, "-y", height, "-ab", str(arguments.bounces), *options]


def render(arguments, options, path):
    """Seconds, and values in the cache."""
    with tempfile.TemporaryDirectory() as scratch:
        stats = os.path.join(scratch, "stats.json")
        seconds = run(arguments, [os.path.abspath(arguments.lightwalk), "render", "--quiet", *view_options(arguments, options),
                                  "--stats", stats, "-o", os.path.abspath(path), *SCENE])
        return seconds, json.loads(pathlib.Path(stats).read_text()).get("ambient", {}).get("cached", 0)


def render_by_rpict(arguments, options, path):
    with open(path, "wb") as picture:
        seconds = run(arguments, [arguments.rpict, *view_options(arguments, options), os.path.abspath(arguments.octree)], stdout=picture)
    return seconds, ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", required=True, metavar="DIR")
    parser.add_argument("--lightwalk", default="lightwalk", metavar="PROGRAM")
    parser.add_argument("--converged", metavar="FILE.hdr")
    parser.add_argument("--accuracy", type=float, choices=[s[0] for s in SETTINGS])
    parser.add_argument("--size", default="320x240", metavar="XxY")
    parser.add_argument("--divisions", type=int, default=4096)
    parser.add_argument("--bounces", type=int, default=1)
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--rpict", metavar="PROGRAM")
    parser.add_argument("--octree", metavar="FILE")
    arguments = parser.parse_args()
    if arguments.converged and not os.path.exists(arguments.converged):
        render(arguments, ["-aa", "0", "-ad", str(arguments.divisions), "-as", "0"], arguments.converged)
    reference = read_hdr(arguments.converged) if arguments.converged else None
    settings = [s for s in SETTINGS if arguments.accuracy in (None, s[0])]
    programs = [("lightwalk", n, render, ["-n", n]) for n in arguments.threads.split(",")]
    if arguments.rpict:
        programs.append(("rpict", 1, render_by_rpict, []))
    print("program\tthreads\t-aa\t-ad\tseconds\tvalues\tblock p95\tblock mean\tmean ratio", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "picture.hdr")
        for aa, ad, extra, ar in settings:
            for name, threads, draw, more in programs:
                options = ["-aa", str(aa), "-ad", str(ad), "-as", str(extra), "-ar", str(ar), *more]
                runs = [draw(arguments, options, path) for _ in range(arguments.runs)]
                errors = compare(read_hdr(path), reference) if reference is not None else (math.nan,) * 3
                print(name, threads, aa, ad, f"{statistics.median(r[0] for r in runs):.2f}", runs[-1][1], *(f"{e:.4f}" for e in errors),
                      sep="\t", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

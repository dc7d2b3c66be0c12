#!/usr/bin/python3
"""Rays per second and seconds of three views of the summer cabin, by number of threads.

  render_bench.py --scenes DIR [--lightwalk PROGRAM] [--runs 5] [--threads 1,2,4] [--limit PATH] [--rpict PATH]

DIR is a folder that holds Radiance's sample models: DIR/cabin and DIR/lib. Each view is rendered at 640x480, every
pixel, with neither jitter nor indirect light. One line a measurement, tab-separated: commit, machine, program, view,
threads, median seconds to render, spread (largest - smallest of the runs), million rays a second, seconds to read
and build. Without --threads: 1, 2, 4, ... up to all of this machine's.

With --limit (build/release/perf/embree_limit) bare Embree's rates on one thread stand beside: its primary, shadow and
diffuse rays of the same view, without any shading; its time is what the view's own rays would take at these rates.
With --rpict the same pictures by an installed Radiance (its rpict, with oconv beside it or on PATH) stand beside,
one process; its time holds reading the octree, which oconv made before.
"""
import argparse, json, os, pathlib, platform, shutil, statistics, subprocess, sys, tempfile, time

SCENE = ("pattmats cabin bathroom furniture winpanes.rad mirrors.rad summerday landscape lights.off "
         "daywindows").split()
VIEWS = ["living", "interior", "bath"]
OPTIONS = "-x 640 -y 480 -ps 1 -pj 0 -dj 0 -ab 0".split()


def commit():
    here = pathlib.Path(__file__).resolve().parent
    done = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=here, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def machine():
    names = {line.split(":", 1)[1].strip() for line in read_lines("/proc/cpuinfo") if line.startswith("model name")}
    return f"{', '.join(sorted(names)) or platform.processor() or platform.machine()} x{os.cpu_count()}"


def read_lines(path):
    try:
        return pathlib.Path(path).read_text().splitlines()
    except OSError:
        return []


def thread_counts(text):
    if text:
        return [int(word) for word in text.split(",")]
    count, every = 1, []
    while count < (os.cpu_count() or 1):
        every.append(count)
        count *= 2
    return [*every, os.cpu_count() or 1]


def run(command, folder, environment):
    done = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed: {done.stderr.decode(errors='replace')[-500:]}")


def measure_lightwalk(arguments, folder, environment, view, threads, scratch):
    stats, picture = os.path.join(scratch, "stats.json"), os.path.join(scratch, "picture.hdr")
    runs = []
    for _ in range(arguments.runs):
        run([arguments.lightwalk, "render", "-vf", f"vf/{view}", *OPTIONS, "-n", str(threads), "--quiet",
             "--stats", stats, "-o", picture, *SCENE], folder, environment)
        runs.append(json.loads(pathlib.Path(stats).read_text()))
    seconds = [r["seconds"]["render"] for r in runs]
    middle = statistics.median(seconds)
    setup = statistics.median(r["seconds"]["read"] + r["seconds"]["build"] for r in runs)
    return middle, max(seconds) - min(seconds), runs[0]["rays"], setup


def measure_rpict(arguments, folder, environment, view, octree):
    seconds = []
    for _ in range(arguments.runs):
        start = time.perf_counter()
        run([arguments.rpict, "-vf", f"vf/{view}", *OPTIONS, octree], folder, environment)
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds), max(seconds) - min(seconds)


def measure_limit(arguments, folder, environment, view, rays):
    """Million rays a second by kind, and the seconds that `rays` (stats of a picture) take at these rates."""
    done = subprocess.run([os.path.abspath(arguments.limit), f"vf/{view}", *SCENE], cwd=folder, env=environment,
                          capture_output=True, text=True, check=True)
    rate = {line.split(",")[0]: float(line.split()[-2]) for line in done.stdout.splitlines()}
    singly = rays["specular"] + rays["transmitted"] + rays["ambient"]
    seconds = (rays["primary"] / rate["primary"] + rays["shadow"] / rate["shadow"] + singly / rate["diffuse"]) * 1e-6
    return rate, seconds


def make_octree(arguments, folder, environment, scratch):
    beside = os.path.join(os.path.dirname(arguments.rpict), "oconv")
    oconv = beside if os.path.exists(beside) else shutil.which("oconv")
    if not oconv:
        sys.exit("oconv was found neither beside rpict nor on PATH")
    octree = os.path.join(scratch, "cabin.oct")
    with open(octree, "wb") as out:
        subprocess.run([oconv, "-w", *SCENE], cwd=folder, env=environment, stdout=out, check=True)
    return octree


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", required=True, metavar="DIR")
    parser.add_argument("--lightwalk", default="lightwalk", metavar="PROGRAM")
    parser.add_argument("--limit", metavar="PATH")
    parser.add_argument("--rpict", metavar="PATH")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--threads", default="", metavar="N,N,...")
    parser.add_argument("--views", default=",".join(VIEWS))
    arguments = parser.parse_args()
    folder = os.path.join(arguments.scenes, "cabin")
    environment = dict(os.environ, RAYPATH=".:../lib")
    if os.sep in arguments.lightwalk:
        arguments.lightwalk = os.path.abspath(arguments.lightwalk)
    head = [commit(), machine()]
    print("commit\tmachine\tprogram\tview\tthreads\tmedian s\tspread s\tMrays/s\tsetup s", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        octree = make_octree(arguments, folder, environment, scratch) if arguments.rpict else None
        for view in arguments.views.split(","):
            for threads in thread_counts(arguments.threads):
                middle, spread, rays, setup = measure_lightwalk(arguments, folder, environment, view, threads, scratch)
                print(*head, "lightwalk", view, threads, f"{middle:.3f}", f"{spread:.3f}",
                      f"{rays['total'] / middle * 1e-6:.3f}",
                      f"{setup:.3f}", sep="\t", flush=True)
            if arguments.limit:
                rate, seconds = measure_limit(arguments, folder, environment, view, rays)
                print(*head, "embree", view, 1, f"{seconds:.3f}", "", " ".join(f"{k} {v}" for k, v in rate.items()), "",
                      sep="\t", flush=True)
            if octree:
                middle, spread = measure_rpict(arguments, folder, environment, view, octree)
                print(*head, "rpict", view, 1, f"{middle:.3f}", f"{spread:.3f}", "", "", sep="\t", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

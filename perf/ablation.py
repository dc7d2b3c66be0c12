#!/usr/bin/python3
"""What each technique that makes rays faster gains: pictures of eight scenes with all of them, and with all but one.

  perf/run.sh ablation --scenes DIR [--runs 9] [--size 640x480]      builds, then this
  ablation.py --scenes DIR --lightwalk PROGRAM [--runs 9] [--size 640x480] [--only SCENE,...] [--switches WORD,...]

DIR holds Radiance's sample models: DIR/cabin and DIR/lib. The scenes: the summer cabin by day, by night, from outdoors and with
one bounce of indirect light; the demonstration's lodge; an office of 64 lamps (office.py); a million tiles and a surface of
gensurf of as many cells, as scene_bench.py makes them. The switches are the words of the program's option --ablate, which is for
tests: batches, function-lanes, sample-lanes, leaves, slices, packets.

One thread; the runs of a scene go in turns: all on, without the first, without the second, and so on. One line a scene,
tab-separated: the median seconds to render with all on (with spread: largest less smallest), then for each switch what it gains:
how many per cent longer the picture takes without it. Seconds to build the search tree count where the switch is of the tree.
Quantised leaves (column "leaves [% MB]") are there for memory: the number is how many per cent more the process takes at its peak without them. The
last line: the geometric mean over the scenes that the switch is for (USED_BY); those are marked by * where a number stands.
Exit code 1 where a picture is not the same to the byte without a technique.
"""
import argparse, json, math, os, pathlib, statistics, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import office, scene_bench

SWITCHES = ["batches", "function-lanes", "sample-lanes", "leaves", "slices", "packets"]
OF_THE_TREE = {"slices"}  # what it costs is paid while it is built
SAVES_MEMORY = {"leaves"}
# The scenes that a technique is for: with many light candidates a point, patterned windows, large models, long cones.
USED_BY = {
    "batches": ["day", "night", "outdoors", "ab1", "lodge", "office"],
    "function-lanes": ["day", "ab1", "lodge", "office"],
    "sample-lanes": ["day", "night", "ab1", "lodge", "office"],
    "leaves": ["tiles", "gensurf"],
    "slices": ["outdoors"],
    "packets": ["day", "night", "outdoors", "ab1", "lodge", "office", "tiles", "gensurf"],
}
CABIN = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad"
SUMMER = f"{CABIN} summerday landscape lights.off daywindows"
PLAIN = "-ps 1 -pj 0 -dj 0 -ab 0 -av .1 .1 .1"
SIDE = 1000  # tiles, and cells of gensurf, along each side


def write_gensurf(path):
    path.write_text(scene_bench.LAMP + scene_bench.SURFACE.format(SIDE))


def scenes(arguments, scratch):
    """Of each: its folder, and the words of its picture."""
    cabin, lodge = os.path.join(arguments.scenes, "cabin"), str(HERE.parent / "apps/scenes/lodge")
    above = " ".join(scene_bench.VIEW)
    return {
        "day": (cabin, f"-vf vf/living {PLAIN} {SUMMER}"),
        "night": (cabin, f"-vf vf/living2 {PLAIN} {CABIN} lights"),
        "outdoors": (cabin, f"-vf vf/ext.ne {PLAIN} {SUMMER}"),
        "ab1": (cabin, f"-vf vf/living {PLAIN.replace('-ab 0', '-ab 1')} -aa .2 -ad 256 -as 64 -ar 96 {SUMMER}"),
        "lodge": (lodge, f"-vf views/living.vf {PLAIN} lodge.rad day.rad"),
        "office": (scratch, f"{' '.join(office.VIEW)} {PLAIN} office.rad"),
        "tiles": (scratch, f"{above} tiles.rad"),
        "gensurf": (scratch, f"{above} gensurf.rad"),
    }


def make_scenes(names, scratch):
    folder = pathlib.Path(scratch)
    if "office" in names:
        (folder / "office.rad").write_text(office.office())
    if "tiles" in names:
        scene_bench.write_tiles(folder / "tiles.rad", SIDE)
    if "gensurf" in names:
        write_gensurf(folder / "gensurf.rad")


def pixels(path):
    """A picture without the lines of its header that tell how it was made."""
    data = pathlib.Path(path).read_bytes()
    return data[data.index(b"\n\n"):]


def render(arguments, folder, words, without):
    """Seconds to render and to build, peak memory [bytes], and the picture's bytes."""
    with tempfile.TemporaryDirectory() as out:
        stats, picture = os.path.join(out, "stats.json"), os.path.join(out, "picture.hdr")
        width, height = arguments.size.split("x")
        command = [os.path.abspath(arguments.lightwalk), "render", "--quiet", "-n", "1", "-x", width, "-y", height, "--stats", stats,
                   "-o", picture, *(["--ablate", without] if without else []), *words.split()]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True,
                              env=dict(os.environ, RAYPATH=".:../lib:" + os.environ.get("RAYPATH", "")))
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}: {done.stderr[-500:]}")
        found = json.loads(pathlib.Path(stats).read_text())
        return found["seconds"]["render"], found["seconds"]["build"], found["peak_memory_bytes"], pixels(picture)


def measure(arguments, folder, words):
    """By switch ("": all on) of each run the seconds to render and to build and the memory; and the switches that change the picture."""
    runs, changed, expected = {}, [], None
    for turn in range(arguments.runs + 1):  # the first one warms up
        for without in ["", *arguments.switches]:
            *costs, picture = render(arguments, folder, words, without)
            expected = expected or picture
            if picture != expected and without not in changed:
                changed.append(without)
            if turn > 0:
                runs.setdefault(without, []).append(costs)
    return runs, changed


def gain(runs, switch):
    """Per cent that a picture takes longer, or more memory, without it."""
    def cost(render, build, memory):
        return memory if switch in SAVES_MEMORY else render + (build if switch in OF_THE_TREE else 0)

    def middle(of):
        return statistics.median(cost(*run) for run in runs[of])
    return 100 * (middle(switch) / middle("") - 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", required=True)
    parser.add_argument("--lightwalk", default=str(HERE.parent / "build/release/lightwalk"))
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--only", type=lambda text: text.split(","))
    parser.add_argument("--switches", type=lambda text: text.split(","), default=SWITCHES)
    arguments = parser.parse_args()
    arguments.scenes = os.path.abspath(arguments.scenes)
    print("\t".join(["scene", "seconds", "spread", *(f"{switch} [% MB]" if switch in SAVES_MEMORY else f"{switch} [%]" for switch in arguments.switches)]), flush=True)
    gains, wrong = {switch: [] for switch in arguments.switches}, 0
    with tempfile.TemporaryDirectory() as scratch:
        every = scenes(arguments, scratch)
        names = arguments.only or list(every)
        make_scenes(names, scratch)
        for name in names:
            runs, changed = measure(arguments, *every[name])
            seconds = [render for render, *_ in runs[""]]
            cells = [name, f"{statistics.median(seconds):.3f}", f"{max(seconds) - min(seconds):.3f}"]
            for switch in arguments.switches:
                used = name in USED_BY[switch]
                cells.append(f"{gain(runs, switch):.1f}{'*' if used else ''}")
                if used:
                    gains[switch].append(1 + gain(runs, switch) / 100)
            print("\t".join(cells), flush=True)
            for switch in changed:
                wrong += 1
                print(f"{name}: the picture is another one without {switch}", file=sys.stderr)
    means = [f"{100 * (math.prod(of) ** (1 / len(of)) - 1):.1f}" if of else "" for of in gains.values()]
    print("\t".join(["geometric mean", "", "", *means]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

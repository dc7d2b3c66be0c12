#!/usr/bin/python3
"""Rooms whose windows are BSDF data, beside an installed Radiance and beside the same rooms with panes of glass.

  bsdf_bench.py [--scenes DIR] [--rpict PATH] [--lightwalk PROGRAM] [--runs 3] [--threads 2] [--pick REGEX] [--size 1] [--keep FOLDER] [--instructions]

DIR is a folder that holds Radiance's sample models: DIR/cabin and DIR/lib; without it there are no rows of the cabin, without rpict
no columns of it. Each row is a picture, by direct light or with two bounces: seconds of whole processes (the median of runs that take
turns), Lightwalk on --threads threads and rpict with an octree that oconv made before, and how many times rpict's time is ours: by the
clock, and by processor time on as many threads. The rooms' data is made by bsdf_data.py: `blind` is a matrix over Klems' full basis
(slats that let light down and up), `pane` a tensor tree of rank 4 with a peak straight on, as aBSDF; `proxy` has slats as geometry, and
the matrix for scattered light. With --instructions one run each under valgrind's callgrind, ours on one thread, and 10^9 instructions in
place of seconds, which do not depend on what else the machine does (a small --size: it takes fifty times as long). Rooms are the cabin's living room, whose panes get the data, and a room of one window. --keep leaves
scenes and pictures there.
"""
import argparse, os, pathlib, re, resource, shutil, statistics, subprocess, sys, tempfile, time

import bsdf_data
from render_bench import SCENE, commit, machine, run

LIGHTS = {  # options, and the size of the picture
    "direct": ("-ab 0 -av .02 .02 .02".split(), (1280, 960)),
    "bounces": ("-ab 2 -av 0 0 0 -aa .2 -ad 256 -as 64 -ar 64".split(), (240, 180)),
}
OPTIONS = "-ps 1 -pj 0 -pt 0 -dj 0 -ds .2 -dt .05 -dc .5 -dr 1 -st .05 -ss 1 -lr 6 -lw .002".split()

ROOM = """
void plastic wall 0 0 5 .6 .6 .55 0 0
void plastic ceiling 0 0 5 .8 .8 .8 0 0
void plastic wood 0 0 5 .35 .2 .1 .02 .05
void plastic ground 0 0 5 .2 .2 .15 0 0
wood polygon floor 0 0 12 0 0 0  4 0 0  4 6 0  0 6 0
ceiling polygon top 0 0 12 0 0 2.8  0 6 2.8  4 6 2.8  4 0 2.8
wall polygon left 0 0 12 0 0 0  0 6 0  0 6 2.8  0 0 2.8
wall polygon right 0 0 12 4 0 0  4 0 2.8  4 6 2.8  4 6 0
wall polygon back 0 0 12 0 6 0  4 6 0  4 6 2.8  0 6 2.8
wall polygon sill 0 0 12 0 0 0  0 0 .8  4 0 .8  4 0 0
wall polygon lintel 0 0 12 0 0 2.4  0 0 2.8  4 0 2.8  4 0 2.4
wall polygon pier1 0 0 12 0 0 .8  0 0 2.4  .4 0 2.4  .4 0 .8
wall polygon pier2 0 0 12 3.6 0 .8  3.6 0 2.4  4 0 2.4  4 0 .8
!genbox wood desk 1.6 .8 .05 | xform -t .4 1.5 .7 -a 2 -t 1.7 0 0
!genbox wood leg .05 .05 .7 | xform -t .45 1.55 0 -a 2 -t 1.4 0 0 -a 2 -t 0 .6 0
!genbox wall shelf 3 .3 1.8 -r .03 | xform -t .5 5.6 0
ground ring field 0 0 8 0 0 -.5  0 0 1  0 60
!gensky 6 21 10 +s -g .2
skyfunc glow sky_glow 0 0 4 .9 .9 1.1 0
sky_glow source sky 0 0 4 0 0 1 180
skyfunc glow ground_glow 0 0 4 1.2 1.1 .9 0
ground_glow source below 0 0 4 0 0 -1 180
"""
WINDOW = "{} polygon window 0 0 12 .4 0 .8  .4 0 2.4  3.6 0 2.4  3.6 0 .8\n"  # its normal is into the room
ROOMS = {
    "glass": "void glass system 0 0 3 .8 .8 .8\n" + WINDOW.format("system"),
    "blind": "void BSDF system 6 0 blind.xml 0 0 1 . 0 0\n" + WINDOW.format("system"),
    "pane": "void aBSDF system 5 pane.xml 0 0 1 . 0 0\n" + WINDOW.format("system"),
    "proxy": "void BSDF system 6 .1 blind.xml 0 0 1 . 0 0\n" + WINDOW.format("system")
             + "!genblinds wall slats .06 3.2 1.6 30 25 | xform -rz 90 -t 3.6 -.08 .8\n",
}
PANES = {"cabin": "", "cabin blind": "void BSDF window_glass\n6 0 {}/blind.xml 0 0 1 .\n0\n0\n",
         "cabin pane": "void aBSDF window_glass\n5 {}/pane.xml 0 0 1 .\n0\n0\n"}
VIEW = "-vtv -vp 3.2 5.2 1.6 -vd -.3 -1 -.12 -vu 0 0 1 -vh 70 -vv 55".split()


def make_rooms(folder):
    (folder / "blind.xml").write_text(bsdf_data.blind_file())
    (folder / "pane.xml").write_text(bsdf_data.pane_file())
    for name, window in ROOMS.items():
        (folder / f"{name}.rad").write_text(ROOM + window)


def cabin_scene(cabin, folder, name):
    """The cabin's files; where its panes get data, with a changed copy of its materials."""
    if not PANES[name]:
        return SCENE
    glass = re.compile(r"void glass window_glass\s+0\s+0\s+3\s+\S+\s+\S+\s+\S+")
    text, count = glass.subn(PANES[name].format(folder), (pathlib.Path(cabin) / "pattmats").read_text())
    if count != 1:
        sys.exit("the cabin's window_glass was not found")
    path = folder / f"{name.replace(' ', '-')}.mat"
    path.write_text(text)
    return [str(path), *SCENE[1:]]


def timed(command, folder, environment):
    """Seconds by the clock, and of processors."""
    def used():
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime
    start, before = time.perf_counter(), used()
    run(command, folder, environment)
    return time.perf_counter() - start, used() - before


def counted(command, folder, environment):
    """10^9 instructions, twice: they are the same for every clock."""
    told = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command], cwd=folder, env=environment,
                          check=True, capture_output=True, text=True).stderr
    found = int(re.search(r"Collected : (\d+)", told)[1]) / 1e9
    return found, found


def make_octree(arguments, folder, environment, scene, path):
    with open(path, "wb") as out:
        done = subprocess.run([os.path.join(os.path.dirname(arguments.rpict), "oconv"), "-w", *scene], cwd=folder, env=environment,
                              stdout=out, stderr=subprocess.PIPE)
    if done.returncode != 0:
        sys.exit(f"oconv failed: {done.stderr.decode(errors='replace')[-500:]}")


def measure(arguments, folder, environment, options, scene, scratch, name):
    """Seconds of ours and of rpict's runs, which take turns; none of rpict's where it is not there."""
    octree = scratch / f"{name}.oct"
    if arguments.rpict:
        make_octree(arguments, folder, environment, scene, octree)
    ours, theirs = [], []
    if arguments.instructions:
        picture = scratch / f"{name}.rpict.hdr"
        picture.unlink(missing_ok=True)
        count = lambda command: counted(command, folder, environment)
        return ([count([arguments.lightwalk, "render", *options, "-n", "1", "--quiet", "-o", str(scratch / f"{name}.hdr"), *scene])],
                [count([arguments.rpict, *options, "-o", str(picture), str(octree)])] if arguments.rpict else [])
    for _ in range(arguments.runs):
        ours.append(timed([arguments.lightwalk, "render", *options, "-n", str(arguments.threads), "--quiet",
                           "-o", str(scratch / f"{name}.hdr"), *scene], folder, environment))
        if arguments.rpict:
            picture = scratch / f"{name}.rpict.hdr"
            picture.unlink(missing_ok=True)  # which rpict does not overwrite
            theirs.append(timed([arguments.rpict, *options, "-o", str(picture), str(octree)], folder, environment))
    return ours, theirs


def cells(ours, theirs, threads):
    def median(runs, which):
        return statistics.median(run[which] for run in runs)
    clocks = [[clock for clock, _ in runs] for runs in (ours, theirs) if runs]
    numbers = [f"{number:.3f}" for runs in clocks for number in (statistics.median(runs), max(runs) - min(runs))]
    if not theirs:
        return numbers + ["-"] * 4
    return numbers + [f"{median(theirs, 0) / median(ours, 0):.1f}", f"{threads * median(theirs, 1) / median(ours, 1):.1f}"]


def find_rpict(named):
    """Its path; None where there is none, unless it was asked for."""
    found = shutil.which(named or "rpict")
    if named and not found:
        sys.exit(f"{named} was not found")
    return found and os.path.abspath(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", metavar="DIR")
    parser.add_argument("--lightwalk", default="lightwalk", metavar="PROGRAM")
    parser.add_argument("--rpict", metavar="PATH", help="default: the one on the PATH, if any")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--pick", default="", metavar="REGEX", help="of the pictures 'ROOM direct' and 'ROOM bounces'")
    parser.add_argument("--size", type=float, default=1, help="times the pictures' width and height")
    parser.add_argument("--keep", metavar="FOLDER")
    parser.add_argument("--instructions", action="store_true")
    arguments = parser.parse_args()
    if os.sep in arguments.lightwalk:
        arguments.lightwalk = os.path.abspath(arguments.lightwalk)
    arguments.rpict = find_rpict(arguments.rpict)
    if arguments.instructions:
        arguments.threads = 1
    environment = dict(os.environ, RAYPATH=f".:{os.environ.get('RAYPATH', '')}")
    if arguments.scenes:
        environment["RAYPATH"] = f".:{os.path.abspath(arguments.scenes)}/lib:{os.environ.get('RAYPATH', '')}"
    if arguments.rpict:
        environment["PATH"] = os.path.dirname(arguments.rpict) + os.pathsep + os.environ.get("PATH", "")
    print(f"{commit()}\t{machine()}\t{arguments.threads} threads")
    unit = "10^9" if arguments.instructions else "s"
    print(f"picture\tours {unit}\tspread {unit}\trpict {unit}\tspread {unit}\ttimes\tof processors", flush=True)
    with tempfile.TemporaryDirectory() as made:
        scratch = pathlib.Path(arguments.keep or made).resolve()
        scratch.mkdir(parents=True, exist_ok=True)
        make_rooms(scratch)
        for light, (options, size) in LIGHTS.items():
            pixels = [word for name, n in zip("xy", size) for word in (f"-{name}", str(max(1, round(n * arguments.size))))]
            for room in (*(PANES if arguments.scenes else ()), *ROOMS):
                if not re.search(arguments.pick, f"{room} {light}"):
                    continue
                cabin = os.path.abspath(f"{arguments.scenes}/cabin")
                folder, view, scene = ((cabin, ["-vf", "vf/living"], cabin_scene(cabin, scratch, room)) if room in PANES else
                                       (scratch, VIEW, [f"{room}.rad"]))
                result = measure(arguments, folder, environment, [*view, *OPTIONS, *options, *pixels], scene, scratch,
                                 f"{room}-{light}".replace(" ", "-"))
                print("\t".join([f"{room} {light}", *cells(*result, arguments.threads)]), flush=True)


if __name__ == "__main__":
    main()

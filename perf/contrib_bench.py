#!/usr/bin/python3
"""Daylight coefficients of a room's sensors: lightwalk contrib beside Radiance's rcontrib, whole processes in turns, a core each.

  contrib_bench.py --radiance DIR --library DIR [--lightwalk PROGRAM] [--sensors 20x10] [--subdivision 1] [--divisions 1024]
                   [--bounces 3] [--runs 3]

--radiance holds Radiance's programs oconv and rcontrib, --library its function files (reinhart.cal). The room has a window, furniture and an
overhang; the sensors lie on a grid above the floor. Prints for each program the seconds of processor time of each run and their median,
then the ratio, and how the coefficients differ: of the sums over the sky, the mean and the root mean square of the relative difference.
"""
import argparse, array, os, pathlib, resource, statistics, subprocess, tempfile

ROOM = """
void plastic wall 0 0 5 .6 .6 .6 0 0
void plastic floor 0 0 5 .3 .25 .2 0 0
void plastic ceiling 0 0 5 .8 .8 .8 0 0
void plastic ground 0 0 5 .2 .2 .2 0 0
void plastic wood 0 0 5 .4 .3 .2 0 0
void glass pane 0 0 3 .88 .88 .88
void glow sky 0 0 4 1 1 1 0
sky source dome 0 0 4 0 0 1 180
ground ring earth 0 0 8 0 0 -.5 0 0 1 0 200
floor polygon f 0 0 12 0 0 0 6 0 0 6 8 0 0 8 0
ceiling polygon c 0 0 12 0 0 3 0 8 3 6 8 3 6 0 3
wall polygon back 0 0 12 0 8 0 6 8 0 6 8 3 0 8 3
wall polygon left 0 0 12 0 0 0 0 8 0 0 8 3 0 0 3
wall polygon right 0 0 12 6 0 0 6 0 3 6 8 3 6 8 0
wall polygon front 0 0 30 0 0 0 0 0 3 6 0 3 6 0 0 1 0 0 1 0 .9 5 0 .9 5 0 2.6 1 0 2.6 1 0 0
pane polygon window 0 0 12 1 0 .9 1 0 2.6 5 0 2.6 5 0 .9
wall polygon overhang 0 0 12 0 0 3 0 -1 3 6 -1 3 6 0 3
!genbox wood table 1.6 .8 .72 | xform -t 2 2 0 -a 3 -t 0 2 0
!genbox wood shelf .4 2 1.8 | xform -t 5.5 4 0
"""


def processor_seconds(command, rays):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    output = subprocess.run(command, input=rays, stdout=subprocess.PIPE, check=True).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, output


def sky_sums(output, sensors):
    """Mean of the channels of the sum over all bins, for each sensor."""
    numbers = array.array("f", output)
    size = len(numbers) // sensors
    return [sum(numbers[i * size:(i + 1) * size]) / 3 for i in range(sensors)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radiance", required=True)
    parser.add_argument("--library", required=True)
    parser.add_argument("--lightwalk", default=str(pathlib.Path(__file__).resolve().parent.parent / "build/release/lightwalk"))
    parser.add_argument("--sensors", default="20x10")
    parser.add_argument("--subdivision", type=int, default=1)
    parser.add_argument("--divisions", type=int, default=1024)
    parser.add_argument("--bounces", type=int, default=3)
    parser.add_argument("--runs", type=int, default=3)
    a = parser.parse_args()
    os.environ["RAYPATH"] = f".:{a.library}"
    os.environ["PATH"] = f"{a.radiance}:{os.environ['PATH']}"
    columns, rows = map(int, a.sensors.split("x"))
    rays = "".join(f"{(i + .5) * 6 / rows:.4f} {(j + .5) * 8 / columns:.4f} .8 0 0 1\n" for i in range(rows) for j in range(columns)).encode()
    sensors = columns * rows
    with tempfile.TemporaryDirectory() as scratch:
        scene, octree = f"{scratch}/room.rad", f"{scratch}/room.oct"
        pathlib.Path(scene).write_text(ROOM)
        with open(octree, "wb") as out:
            subprocess.run(["oconv", scene], stdout=out, check=True)
        options = (f"-h- -faf -n 1 -I+ -ab {a.bounces} -ad {a.divisions} -lw {.2 / a.divisions:.1e} -e MF:{a.subdivision} -f reinhart.cal "
                   "-b rbin -bn Nrbins -m sky").split()
        programs = {"lightwalk": [a.lightwalk, "contrib", *options, octree], "rcontrib": ["rcontrib", *options, octree]}
        seconds, sums = {name: [] for name in programs}, {}
        for _ in range(a.runs):
            for name, command in programs.items():
                taken, output = processor_seconds(command, rays)
                seconds[name].append(taken)
                sums[name] = sky_sums(output, sensors)
    for name, taken in seconds.items():
        print(f"{name}\t{' '.join(f'{t:.2f}' for t in taken)}\tmedian {statistics.median(taken):.2f} s\tsum over sensors {sum(sums[name]):.4f}")
    print(f"ratio\t{statistics.median(seconds['rcontrib']) / statistics.median(seconds['lightwalk']):.2f}")
    relative = [x / y - 1 for x, y in zip(sums["lightwalk"], sums["rcontrib"]) if y > 0]
    print(f"difference\tmean {statistics.mean(relative):+.4f}\trms {statistics.mean(r * r for r in relative) ** .5:.4f}")


main()

#!/usr/bin/python3
"""Daylight coefficients of a room's sensors: lightwalk contrib, without and with --cache, beside Radiance's rcontrib; whole processes in turns, a
core each.

  contrib_bench.py --radiance DIR --library DIR [--lightwalk PROGRAM] [--sensors 20x10] [--subdivisions 1,4] [--divisions 128,256,1024,2048,4096]
                   [--bounces 3] [--runs 3] [--converged 65536] [--options "..."]

--radiance holds Radiance's programs oconv and rcontrib, --library its function files (reinhart.cal). The room has a window, furniture and an
overhang; the sensors lie on a grid above the floor. For each subdivision of the sky (MF) and each -ad it prints for each program the processor time
(median), and the error against converged coefficients, those of lightwalk contrib, uncached, with another seed and --converged divisions:
of the coefficients, the root mean square of the difference in that of the coefficients; and the same for sums over the sky. Then at how much
time lightwalk has the error that rcontrib has with the middle one of the divisions (by interpolation, "none": at no time), and how its mean differs
from the converged one. --options are further ones of lightwalk contrib --cache. --converged 0 leaves errors out.
"""
import argparse, array, math, os, pathlib, resource, statistics, subprocess, tempfile

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


def coefficients(output, sensors):
    """For each sensor the mean of the channels of each bin."""
    numbers = array.array("f", output)
    size = len(numbers) // sensors
    return [[sum(numbers[i * size + 3 * bin:i * size + 3 * bin + 3]) / 3 for bin in range(size // 3)] for i in range(sensors)]


def relative_error(found, expected):
    square = sum((a - b) ** 2 for x, y in zip(found, expected) for a, b in zip(x, y))
    return (square / sum(b * b for y in expected for b in y)) ** .5


def sums(rows):
    return [[sum(row)] for row in rows]


def time_at(error, seconds, errors):
    """When a program has this error, from its errors at some times, on logarithmic scales; None: at none of them, nor beyond the last."""
    points = sorted(zip(seconds, errors))
    if points[0][1] <= error:
        return points[0][0]  # at the latest
    for (t, e), (u, f) in zip(points, points[1:]):
        if f <= error < e:
            return t * (u / t) ** (math.log(e / error) / math.log(e / f))
    return None


class Bench:
    def __init__(self, a, scratch):
        self.a, self.scratch = a, scratch
        columns, rows = map(int, a.sensors.split("x"))
        self.sensors = columns * rows
        self.rays = "".join(f"{(i + .5) * 6 / rows:.4f} {(j + .5) * 8 / columns:.4f} .8 0 0 1\n" for i in range(rows) for j in range(columns)).encode()
        self.octree = f"{scratch}/room.oct"
        scene = f"{scratch}/room.rad"
        pathlib.Path(scene).write_text(ROOM)
        with open(self.octree, "wb") as out:
            subprocess.run(["oconv", scene], stdout=out, check=True)

    def run(self, program, subdivision, divisions, more=()):
        options = (f"-h- -faf -n 1 -I+ -ab {self.a.bounces} -ad {divisions} -lw {.2 / divisions:.1e} -e MF:{subdivision} -f reinhart.cal "
                   "-b rbin -bn Nrbins -m sky").split()
        seconds, output = processor_seconds([*program, *options, *more, self.octree], self.rays)
        return seconds, output

    def compare(self, subdivision):
        ours = [self.a.lightwalk, "contrib"]
        programs = {"rcontrib": (["rcontrib"], []), "lightwalk": (ours, []), "--cache": (ours, ["--cache", *self.a.options.split()])}
        converged = None
        if self.a.converged:
            _, output = self.run(ours, subdivision, self.a.converged, ["--seed", "1234"])
            converged = coefficients(output, self.sensors)
        print(f"MF:{subdivision}\t-ad\tseconds\terror of coefficients\tof sums\tof the mean")
        table = {name: [] for name in programs}
        # All divisions in turns, too: how fast a machine is changes within a run.
        seconds = {(name, divisions): [] for name in programs for divisions in self.a.divisions}
        outputs = {}
        for _ in range(self.a.runs):
            for divisions in self.a.divisions:
                for name, (program, more) in programs.items():
                    taken, outputs[name, divisions] = self.run(program, subdivision, divisions, more)
                    seconds[name, divisions].append(taken)
        for divisions in self.a.divisions:
            for name in programs:
                found = coefficients(outputs[name, divisions], self.sensors)
                self.tell(name, divisions, statistics.median(seconds[name, divisions]), found, converged, table)
        middle = len(self.a.divisions) // 2
        reference = table["rcontrib"][middle]
        for name in ("lightwalk", "--cache"):
            print(f"{name}\tat -ad {self.a.divisions[middle]} rcontrib takes {reference[0] / table[name][middle][0]:.1f} times as long", end="")
            if converged:
                at = time_at(reference[1], [row[0] for row in table[name]], [row[1] for row in table[name]])
                print("; its error " + (f"within {at:.3f} s: {reference[0] / at:.1f} times as fast" if at else "at no time: none"), end="")
            print()

    def tell(self, name, divisions, seconds, found, converged, table):
        row = [seconds]
        text = f"{name}\t{divisions}\t{seconds:.3f}"
        if converged:
            all_of = [sum(map(sum, rows)) for rows in (found, converged)]
            row += [relative_error(found, converged), relative_error(sums(found), sums(converged)), all_of[0] / all_of[1] - 1]
            text += f"\t{row[1]:.4f}\t{row[2]:.4f}\t{row[3]:+.4f}"
        table[name].append(row)
        print(text, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radiance", required=True)
    parser.add_argument("--library", required=True)
    parser.add_argument("--lightwalk", default=str(pathlib.Path(__file__).resolve().parent.parent / "build/release/lightwalk"))
    parser.add_argument("--sensors", default="20x10")
    numbers = lambda text: [int(word) for word in text.split(",")]
    parser.add_argument("--subdivisions", type=numbers, default=[1, 4])
    parser.add_argument("--divisions", type=numbers, default=[128, 256, 1024, 2048, 4096])
    parser.add_argument("--bounces", type=int, default=3)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--converged", type=int, default=65536)
    parser.add_argument("--options", default="")
    a = parser.parse_args()
    os.environ["RAYPATH"] = f".:{a.library}"
    os.environ["PATH"] = f"{a.radiance}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(a, scratch)
        for subdivision in a.subdivisions:
            bench.compare(subdivision)


main()

#!/usr/bin/python3
"""What a short call costs: a few rays on an octree, as scripts ask rtrace for them a thousand times; whole processes.

  start_bench.py PROGRAM [--rtrace FILE] [--served] [--octree FILE]... [--runs N] [--options "WORDS"]

PROGRAM: lightwalk; --rtrace: another program to compare with, by turns in the same run (Radiance's); --served: by a
server of the octree as well (lightwalk trace --serve), whose own processor time is counted, too. Octrees are those that
are named, each with the point that its rays come from, FILE:X,Y,Z; without any a room of six walls and the demo scene by night, which are
made in a temporary folder. RAYPATH says where files are that octrees refer to. Prints medians of processor time and of
time that passes, in milliseconds, and how many times as long PROGRAM takes."""
import argparse
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
LODGE = ROOT / "apps/scenes/lodge"
ROOM = """void plastic white 0 0 5 .7 .7 .7 0 0
void light lamp 0 0 3 9 9 9
!genbox white room 4 5 3 -i
lamp polygon ceiling 0 0 12 1 1 2.9 1 2 2.9 2 2 2.9 2 1 2.9
"""


def made_octrees(program, folder):
    """A room and the demo scene: file and point of each."""
    names = folder / "names"
    subprocess.run([program, "install-names", names], check=True, stdout=subprocess.DEVNULL)
    room = folder / "room.rad"
    room.write_text(ROOM)
    # oconv runs the scene's commands, as Radiance's does.
    environment = {**os.environ, "PATH": f"{names}:{os.environ['PATH']}"}
    made = [(folder / "room.oct", folder, [room], (2, 2.5, 1)),
            (folder / "lodge.oct", LODGE, ["lodge.rad", "night.rad"], (9.2, 6.3, 1.7))]
    for file, place, scenes, _ in made:
        with open(file, "wb") as output:
            subprocess.run([names / "oconv", "-f", *scenes], cwd=place, env=environment, check=True, stdout=output)
    return [(file, point) for file, _, _, point in made]


def cost(words, rays):
    """Milliseconds of processor time and of time that passes, of a whole process."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(words, input=rays, check=True, stdout=subprocess.DEVNULL)
    seconds, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1000 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime), 1000 * seconds


class Server:
    """Of an octree, in a runtime folder of its own."""

    def __init__(self, program, octree, folder):
        self.runtime = folder / "runtime"
        self.runtime.mkdir(mode=0o700, exist_ok=True)
        os.environ["XDG_RUNTIME_DIR"] = str(self.runtime)
        self.process = subprocess.Popen([program, "trace", "--serve", octree], stdin=subprocess.DEVNULL)
        while not any(file.is_socket() for file in (self.runtime / "lightwalk").glob("*")):
            if self.process.poll() is not None:
                sys.exit("the server has ended")
            time.sleep(0.01)

    def processor(self):
        """Milliseconds so far, of the process and of those that it has forked."""
        words = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return 1000 * sum(map(int, words[11:15])) / os.sysconf("SC_CLK_TCK")

    def end(self):
        self.process.terminate()
        self.process.wait()


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument("program")
    parser.add_argument("--rtrace")
    parser.add_argument("--served", action="store_true")
    parser.add_argument("--octree", action="append", default=[])
    parser.add_argument("--runs", type=int, default=21)
    parser.add_argument("--options", default="-h -I -ab 0")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(given.program).resolve()
        octrees = [(file, point.split(",")) for file, point in (name.rsplit(":", 1) for name in given.octree)]
        # The demo's octree names files beside the scene.
        os.environ["RAYPATH"] = f".:{LODGE}:{os.environ.get('RAYPATH', '')}"
        octrees = octrees or made_octrees(program, pathlib.Path(folder))
        ours = [program, "trace", "-n", "1"]
        programs = {"lightwalk": ours, **({"rtrace": [given.rtrace]} if given.rtrace else {})}
        names = pathlib.Path(folder) / "served"
        if given.served:
            subprocess.run([program, "install-names", "--serve", names], check=True, stdout=subprocess.DEVNULL)
            programs["served"] = [names / "rtrace"]
        for octree, point in octrees:
            server = Server(program, octree, pathlib.Path(folder)) if given.served else None
            before = server.processor() if server else 0
            rays = (" ".join(map(str, point)) + " 0 0 1\n").encode() * 4
            costs = {name: [] for name in programs}
            for _ in range(given.runs):
                for name, words in programs.items():
                    costs[name].append(cost([*words, *given.options.split(), octree], rays))
            shared = (server.processor() - before) / given.runs if server else 0
            if server:
                server.end()
                costs["served"] = [(processor + shared, passed) for processor, passed in costs["served"]]
            for name, runs in costs.items():
                processor, passed = (statistics.median(run[k] for run in runs) for k in (0, 1))
                ratio = statistics.median(run[0] for run in costs["lightwalk"]) / processor if processor else float("nan")
                print(f"{pathlib.Path(octree).stem:10} {name:10} {processor:7.1f} {passed:7.1f}   {ratio:.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""`lightwalk launch` by Slurm's srun, in place of which there is a script that starts the ranks by mpirun: srun_test.py PROGRAM

A picture is the one that the program draws alone, ranks read from standard input what rank 0 should, a host that does not answer is left out, and a walk survives a rank that is killed."""
import json, os, pathlib, shutil, signal, subprocess, sys, tempfile

from launched_walk_test import free_port, ranks_of, soon, visit
from scripted_walk import PATIENCE, ROOM, WORDS

NEEDED = ["--mpi=pmix", "--kill-on-bad-exit=1", "--unbuffered", "--input=0", "--quit-on-interrupt", "--export=ALL"]
MISSING = "nowhere.invalid"  # no name (RFC 6761)
SRUN = """#!/usr/bin/python3
import json, os, pathlib, re, signal, socket, subprocess, sys
words = sys.argv[1:]
with open(os.environ["FAKE_SRUN"] + "/calls", "a") as file:
    print(json.dumps(words), file=file)
first = next(i for i, word in enumerate(words) if not word.startswith("--"))
options = dict(word.split("=", 1) for word in words[:first] if "=" in word)
if "MISSING" in options.get("--nodelist", ""):
    sys.exit("srun: error: Unable to create step: Required node not available (down, drained or reserved)")
mpirun = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "orte_tmpdir_base", os.environ["FAKE_SRUN"], "-n", options["--ntasks"]]
ranks = subprocess.Popen([*mpirun, *words[first:]], stderr=subprocess.PIPE, text=True)
signal.signal(signal.SIGTERM, lambda *_: ranks.terminate())
lost = None
for line in ranks.stderr:
    lost = lost or re.search(r"rank (\\d+) with PID \\d+ on node .* exited on signal 9", line)
    if "mpirun" not in line and not line.startswith("---"):
        sys.stderr.write(line)
status = ranks.wait()
if lost:
    print(f"srun: error: {socket.gethostname()}: task {lost[1]}: Killed", file=sys.stderr)
sys.exit(status if status >= 0 else 128 - status)
""".replace("MISSING", MISSING)


class Slurm:
    """A job of Slurm's, as programs see it."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        srun = self.folder / "bin" / "srun"
        srun.parent.mkdir()
        srun.write_text(SRUN)
        srun.chmod(0o755)
        os.environ.update(PATH=f"{srun.parent}:{os.environ['PATH']}", FAKE_SRUN=str(folder), SLURM_JOB_ID="7")

    def calls(self):
        """The words of all calls since the last time."""
        file = self.folder / "calls"
        lines = file.read_text().splitlines() if file.exists() else []
        file.unlink(missing_ok=True)
        return [json.loads(line) for line in lines]


def run(words, **more):
    return subprocess.run([str(word) for word in words], capture_output=True, timeout=4 * PATIENCE, **more)


def pixels(file):
    return file.read_bytes().split(b"\n\n", 1)[1]


def check_pictures(program, slurm, scene):
    picture = ["-n", "1", *WORDS.split(), "-x", "80", "-y", "60"]
    alone, many = slurm.folder / "alone.hdr", slurm.folder / "many.hdr"
    assert run([program, "render", *picture, "-o", alone, scene]).returncode == 0
    hosts = slurm.folder / "hosts"
    hosts.write_text(f"127.0.0.1 slots=2\n{MISSING}\n")
    made = run([program, "launch", "--hosts", hosts, "render", *picture, "--checkpoint", slurm.folder / "kept", "-o", many, scene])
    assert made.returncode == 0 and f"{MISSING} does not answer" in made.stderr.decode(), made
    assert pixels(alone) == pixels(many)
    first, second = slurm.calls()
    assert first[:9] == [*NEEDED, f"--nodelist=127.0.0.1,{MISSING}", "--nodes=2", "--ntasks=3"], first
    assert second[:9] == [*NEEDED, "--nodelist=127.0.0.1", "--nodes=1", "--ntasks=2"], second
    assert second[9:12] == [os.path.realpath(program), "render", "--resume"], second
    rays = b"0 -4 1.5 0 1 0\n" * 20
    traced = run([program, "launch", "--ranks", "2", "--srun", "--mpi=pmi2 --time=5", "trace", "-h", "-n", "1", scene], input=rays)
    assert traced.returncode == 0, traced
    assert traced.stdout == run([program, "trace", "-h", "-n", "1", scene], input=rays).stdout
    assert slurm.calls()[0][:9] == [*NEEDED, "--ntasks=2", "--mpi=pmi2", "--time=5"]
    both = run([program, "launch", "--mpirun", "", "--srun", "", "trace", scene])
    assert both.returncode == 2 and b"--srun" in both.stderr, both
    by_mpirun = run([program, "launch", "--ranks", "1", "--mpirun", "--oversubscribe", "trace", "-h", "-n", "1", scene], input=rays)
    assert by_mpirun.stdout == traced.stdout and not slurm.calls(), by_mpirun


def check_walk(program, slurm, scene):
    port = free_port()
    launch = subprocess.Popen([program, "launch", "--ranks", "2", "walk", "--port", str(port), "-n", "1", *WORDS.split(), scene],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert launch.stdout.readline() == f"http://127.0.0.1:{port}/\n"
        client = visit(port)
        client.enter()
        os.kill(next(process for process, rank in ranks_of(port).items() if rank == 1), signal.SIGKILL)
        client.told("interrupted", text="rank 1 was killed: the walk begins anew with 2 ranks")
        client.told("welcome")
        client.enter()
    finally:
        launch.terminate()
        errors = launch.communicate(timeout=PATIENCE)[1]
    assert errors.count("begins anew") == 1, errors
    assert len(slurm.calls()) == 2
    soon(lambda: not ranks_of(port), "ranks are left")


def main(program):
    if not shutil.which("mpirun"):
        print("skipped: no mpirun here")
        return 77
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", ASAN_OPTIONS="detect_leaks=0:handle_sigill=1")
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "room.rad"
        scene.write_text(ROOM)
        slurm = Slurm(folder)
        check_pictures(program, slurm, scene)
        check_walk(program, slurm, scene)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

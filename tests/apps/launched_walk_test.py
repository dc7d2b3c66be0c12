#!/usr/bin/python3
"""A walk that `lightwalk launch` started survives the loss of its ranks: launched_walk_test.py PROGRAM [SCENE VIEW]

SCENE and VIEW: files, in place of a small room. Each rank is killed in turn; a client connects again as the page does, tells its view, and gets the picture that it had."""
import os, pathlib, shutil, signal, socket, subprocess, sys, tempfile, time

from walk_server_test import PATIENCE, ROOM, WORDS, Client, Closed

RANKS = 4


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def ranks_of(port):
    """Processes that run the walk, but for those that started them."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if words[1:2] == [b"walk"] and str(port).encode() in words:
            found.append(int(process.name))
    return sorted(found)


def view_of(file):
    """Where the view of a file is, as messages have it."""
    words = file.read_text().split()
    names = {"-vp": "position", "-vd": "direction", "-vu": "up"}
    return {name: [float(word) for word in words[words.index(option) + 1:][:3]] for option, name in names.items() if option in words}


def connected(port):
    end = time.monotonic() + PATIENCE
    while True:
        try:
            return Client(port)
        except OSError:
            assert time.monotonic() < end, "nobody serves the page any more"
            time.sleep(0.05)


def main(program, scene=None, view=None):
    if not shutil.which("mpirun"):
        print("skipped: no mpirun here")
        return 77
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", ASAN_OPTIONS="detect_leaks=0:handle_sigill=1")
    with tempfile.TemporaryDirectory() as folder:
        words = ["-vf", view] if view else WORDS.split()
        place = view_of(pathlib.Path(view)) if view else {"position": [1, -3, 1.5]}
        if scene is None:
            scene = pathlib.Path(folder) / "room.rad"
            scene.write_text(ROOM)
        port = free_port()
        # Sockets of its own: others' runs of MPI may take common ones away (open-mpi/ompi issue 8510).
        mpirun = f"--oversubscribe --bind-to none --mca orte_tmpdir_base {folder}"
        launch = subprocess.Popen([program, "launch", "--ranks", str(RANKS), "--retries", "9", "--mpirun", mpirun, "walk", "--port", str(port), "-n", "1",
                                   *words, scene], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            pictures, times = [], []
            for victim in range(RANKS + 1):
                client = connected(port)
                client.told("loaded")
                client.look(**place)
                client.frame(1)
                drawn = time.monotonic()
                client.until(lambda m: hasattr(m, "at_rest") and m.at_rest)
                pictures.append(client.ask("pick", "picked", x=.5, y=.5))
                if victim > 0:
                    times[-1] = drawn - times[-1]
                if victim == RANKS:
                    break
                ranks = ranks_of(port)
                assert len(ranks) == RANKS, ranks
                os.kill(ranks[victim], signal.SIGKILL)
                times.append(time.monotonic())
                try:
                    client.until(lambda _: False)
                except (Closed, OSError):
                    pass
            assert launch.poll() is None
            strip = lambda picked: {key: value for key, value in picked.items() if key != "id"}
            assert all(strip(one) == strip(pictures[0]) for one in pictures), pictures
            print(f"drawn again {', '.join(f'{seconds:.2f}' for seconds in times)} s after a rank was killed")
        finally:
            launch.terminate()
            errors = launch.communicate(timeout=PATIENCE)[1]
        assert errors.count("begins anew") == RANKS, errors
        end = time.monotonic() + PATIENCE
        while ranks_of(port):
            assert time.monotonic() < end, "ranks are left"
            time.sleep(0.05)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

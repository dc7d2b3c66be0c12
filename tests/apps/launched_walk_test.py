#!/usr/bin/python3
"""A walk that `lightwalk launch` started survives the loss of those who draw it: launched_walk_test.py PROGRAM [SCENE VIEW]

SCENE and VIEW: files, in place of a small room. Each rank is killed in turn, then mpirun. A client stays connected all the time, is told what has happened, tells
its view, dimmers and probes when it is welcomed again, as the page does, and sees and measures what it did before. Who comes meanwhile sees what was drawn last."""
import os, pathlib, re, shutil, signal, socket, subprocess, sys, tempfile, time, urllib.request

from scripted_walk import PATIENCE, ROOM, SIZE, WORDS, Client, Frame

RANKS = 4


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def ranks_of(port):
    """Processes that run the walk, by their ranks, but for those that started them."""
    found = {}
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
            if words[1:2] == [b"walk"] and str(port).encode() in words:
                rank = re.search(rb"OMPI_COMM_WORLD_RANK=(\d+)", (process / "environ").read_bytes())
                found[int(process.name)] = int(rank[1]) if rank else None
        except OSError:
            continue
    return found


def children(process):
    return [int(child) for child in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def view_of(file):
    """Where the view of a file is, as messages have it."""
    words = file.read_text().split()
    names = {"-vp": "position", "-vd": "direction", "-vu": "up"}
    return {name: [float(word) for word in words[words.index(option) + 1:][:3]] for option, name in names.items() if option in words}


def soon(happens, what):
    end = time.monotonic() + PATIENCE
    while not happens():
        assert time.monotonic() < end, what
        time.sleep(0.05)


class Page(Client):
    """Keeps the picture that it sees: the bytes of its pieces, by their places."""
    pieces = {}

    def take(self):
        taken = super().take()
        if isinstance(taken, Frame):
            self.pieces = taken.parts() if taken.whole else {**self.pieces, **taken.parts()}
        return taken


def visit(port, session="fedcba9876543210"):
    """Somebody else opens the page now: gets it, and is told how the walk is."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=PATIENCE) as answer:
        assert b"<title>" in answer.read()
    other = Page(port, session)
    other.until(lambda m: isinstance(m, dict) and m["type"] in ("loading", "welcome"))
    return other


class Gate:
    """An mpirun that waits before it starts anything while the gate is closed."""

    def __init__(self, folder):
        self.closed = pathlib.Path(folder) / "closed"
        mpirun = pathlib.Path(folder) / "bin" / "mpirun"
        mpirun.parent.mkdir()
        mpirun.write_text(f"#!/bin/sh\nwhile [ -e '{self.closed}' ]; do sleep .02; done\nexec '{shutil.which('mpirun')}' \"$@\"\n")
        mpirun.chmod(0o755)
        os.environ["PATH"] = f"{mpirun.parent}:{os.environ['PATH']}"

    def __enter__(self):
        self.closed.touch()

    def __exit__(self, *_):
        self.closed.unlink()


class Watched:
    """What one client says to each run, and sees of it."""

    def __init__(self, client, place, dims):
        self.client, self.place, self.dims = client, place, dims

    def tell(self):
        """After a welcome: what the page tells again. Returns when the first picture is there."""
        client = self.client
        groups = client.told("loaded").get("lights", [])
        if self.dims:
            client.socket.send({"type": "lights", "levels": [{"name": groups[0], "level": .25, "rgb": [1, 1, 1]}]})
        client.look(**self.place)
        client.frame(client.ident)
        return time.monotonic()

    def see(self):
        """What is seen and measured of a view that rests."""
        client = self.client
        client.until(lambda m: isinstance(m, Frame) and m.at_rest)
        picked = client.ask("pick", "picked", x=.5, y=.4)
        pin = {"id": 7, "position": picked["position"], "normal": picked["normal"]}
        client.socket.send({"type": "probes", "probes": [pin]})
        probes = client.told("probes")["probes"]
        return {key: value for key, value in picked.items() if key != "id"}, probes


def lose(launch, client, port, victim, said):
    """Kills a process; returns when."""
    os.kill(victim, signal.SIGKILL)
    killed = time.monotonic()
    told = client.until(lambda m: isinstance(m, dict) and m["type"] == "interrupted" and said in m["text"])
    assert "the walk begins anew with 4 ranks" in told["text"], told
    return killed


def look_meanwhile(port, client, place):
    """Somebody who comes while there is no run sees what the client has seen last, and why it goes no further."""
    assert sum(width * height for _, _, _, width, height in client.pieces) == SIZE[0] * SIZE[1]
    other = visit(port)
    assert other.messages[-1]["type"] == "loading" and "was killed" in other.messages[-1]["text"], other.messages
    assert other.pieces == client.pieces
    view = next(m["view"] for m in other.messages if m["type"] == "view")
    assert all(view[name] == value for name, value in place.items()), (view, place)
    return other


def check_kept(program, scene, folder, mpirun):
    """What those who were lost knew of the picture, those who begin anew know, too: of a scene that is as it was, and is kept nowhere else."""
    os.environ["TMPDIR"] = folder
    port = free_port()
    launch = subprocess.Popen([program, "launch", "--ranks", "2", "--retries", "9", "--mpirun", mpirun, "walk", "--port", str(port), "-n", "1",
                               "--watch", "off", *WORDS.split(), scene], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    kept = lambda: list(pathlib.Path(folder).glob("lightwalk-*/picture"))  # noqa: E731

    def begin_again(how):
        how()
        os.kill(children(launch.pid)[0], signal.SIGKILL)
        client.told("interrupted")
        return begin()

    def begin():
        """How much of the first pictures was known."""
        client.told("loaded")
        client.socket.send({"type": "display", "mode": "tone", "exposure": {"auto": False, "ev": 0}, "human": False,
                            "scale": {"low": 1, "high": 10000, "log": True}, "number": 1})
        client.look()
        return client.until(lambda m: isinstance(m, dict) and m["type"] == "state")["reuse"]

    def at_last():
        client.until(lambda m: isinstance(m, Frame) and m.finished and m.view >= client.ident)
        return client.pieces

    try:
        launch.stdout.readline()
        client = visit(port)
        begin()
        picture = at_last()
        soon(kept, "nothing is kept")
        time.sleep(2.5)  # every other second it is written anew until all of it is known
        known = begin_again(lambda: None)
        assert known > .9, known
        assert at_last() == picture
        client.look(position=[1, -3, 1.5])
        assert at_last() != picture
        client.look()  # whatever was known, and however much was traced at a time
        assert at_last() == picture
        unknown = begin_again(lambda: scene.write_text(scene.read_text() + "grey sphere other 0 0 4 1 2 .7 .7\n"))
        assert unknown < .9, unknown
    finally:
        launch.terminate()
        launch.communicate(timeout=PATIENCE)
    assert not kept(), "the head leaves files behind"


def farewell(client):
    while True:
        message = client.socket.receive()
        if isinstance(message, dict) and message["type"] == "bye":
            return message["reason"]


def main(program, scene=None, view=None):
    if not shutil.which("mpirun"):
        print("skipped: no mpirun here")
        return 77
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", ASAN_OPTIONS="detect_leaks=0:handle_sigill=1")
    with tempfile.TemporaryDirectory() as folder:
        words = ["-vf", view] if view else [*WORDS.split(), "--light-group", "auto"]
        place = view_of(pathlib.Path(view)) if view else {"position": [1, -3, 1.5]}
        dims = scene is None
        if scene is None:
            scene = pathlib.Path(folder) / "room.rad"
            scene.write_text(ROOM)
        port, gate = free_port(), Gate(folder)
        # Sockets of its own: others' runs of MPI may take common ones away (open-mpi/ompi issue 8510).
        mpirun = f"--oversubscribe --bind-to none --mca orte_tmpdir_base {folder}"
        launch = subprocess.Popen([program, "launch", "--ranks", str(RANKS), "--retries", "9", "--mpirun", mpirun, "walk", "--port", str(port), "-n", "1",
                                   *words, scene], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            assert launch.stdout.readline() == f"http://127.0.0.1:{port}/\n"
            client = visit(port, "0123456789abcdef")  # before there are ranks
            watched = Watched(client, place, dims)
            watched.tell()
            expected, times = watched.see(), []
            for victim in range(RANKS):
                ranks = ranks_of(port)
                assert sorted(ranks.values()) == list(range(RANKS)), ranks
                process = next(process for process, rank in ranks.items() if rank == victim)
                killed = lose(launch, client, port, process, f"rank {victim} was killed")
                visit(port).socket.close()
                client.told("welcome", driver=True)
                times.append(watched.tell() - killed)
                seen = watched.see()
                assert seen == expected, (seen, expected)
            before = ranks_of(port)
            with gate:
                lose(launch, client, port, children(launch.pid)[0], "mpirun was killed")
                other = look_meanwhile(port, client, place)
            client.told("welcome", driver=True)
            other.told("welcome", driver=False)
            watched.tell()
            assert watched.see() == expected
            soon(lambda: not set(before) & set(ranks_of(port)), "ranks without mpirun are left")
            assert launch.poll() is None
            print(f"drawn again {', '.join(f'{seconds:.2f}' for seconds in times)} s after a rank was killed")
        finally:
            launch.terminate()
            errors = launch.communicate(timeout=PATIENCE)[1]
        assert errors.count("begins anew") == RANKS + 1, errors
        assert farewell(client) == "the server ends"
        soon(lambda: not ranks_of(port), "ranks are left")
        if dims:
            check_kept(program, scene, folder, mpirun)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

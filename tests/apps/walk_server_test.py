#!/usr/bin/python3
"""`lightwalk walk` as browsers see it, by scripted clients. One name runs one of them; none, all:

    walk_server_test.py PROGRAM [rest|clean|light|intervals|dimmed|changed|roles|mended|followed|rad_file|returning|slow|abuse|beside|ranks ...]
"""
import base64, os, pathlib, random, shutil, signal, socket, subprocess, sys, tempfile, time, urllib.error, urllib.request, zlib

import walk_light
from scripted_walk import PATIENCE, ROOM, SIZE, WORDS, Client, Server
from walk.misbehaviour import VIEW, misbehave
from walk.slow_link import SlowLink
from walk.websocket import Closed, Frame, WebSocket


def rest(program, words=(), launcher=()):
    """A view that rests ends as the picture that `render` draws, with and without indirect light."""
    for light in ([], ["-ab", "1", "-aa", "0", "-ad", "16"]):
        with Server(program, ["--edge-samples", "1", *light, *words], launcher=launcher) as server:
            client = Client(server.port)
            client.told("loaded")
            client.look(direction=[0.1, 1, 0])
            client.frame(1)
            client.look()
            client.until(lambda m: isinstance(m, Frame) and m.view == 2 and m.finished)
            saved = server.get("/save/picture.hdr")
            rendered = subprocess.run([program, "render", "-ps", "1", "-pa", "0", "-x", str(SIZE[0]), "-y", str(SIZE[1]),
                                       *WORDS.split(), *light, server.scene], stdout=subprocess.PIPE, check=True).stdout
            body = [picture.split(b"\n\n", 1)[1] for picture in (saved, rendered)]
            assert body[0] == body[1], "the pictures differ"
            assert b"VIEW= -vtv" in saved.split(b"\n\n")[0]


def clean(program):
    """Where Open Image Denoise is, a view that rests may be shown without noise. What is saved stays as traced; a library that fails is told once."""
    library = os.environ.get("LIGHTWALK_FAKE_DENOISER")
    if not library:
        print("skipped: LIGHTWALK_FAKE_DENOISER names no folder of a library")
        sys.exit(77)
    display = {"type": "display", "mode": "tone", "exposure": {"auto": True, "ev": 0}, "human": False, "clean": True,
               "scale": {"low": 1, "high": 10000, "log": True}}
    for more in ([], ["FAKE_DENOISER=fail"]):
        with Server(program, ["--denoise"], launcher=["/usr/bin/env", f"LD_LIBRARY_PATH={library}", *more]) as server:
            client = Client(server.port)
            assert client.told("welcome")["denoises"]
            client.enter()
            done = lambda m: isinstance(m, Frame) and m.finished  # noqa: E731
            assert not client.until(done).denoised
            body = lambda: server.get("/save/picture.hdr").split(b"\n\n", 1)[1]  # noqa: E731
            traced = body()
            client.socket.send(display)
            if more:
                assert "no memory" in client.told("refused")["text"]
            assert client.until(lambda m: done(m) and m.denoised != bool(more))
            assert body() == traced
            client.look(direction=[0.1, 1, 0])
            assert not client.frame(client.ident).denoised
            client.until(lambda m: done(m) and m.denoised != bool(more))
            assert sum("no memory" in m.get("text", "") for m in client.messages) == len(more)


def dimmed(program, words=(), launcher=()):
    """What is seen of the lamp and of the panel adds up to what is seen, and half of both is half of it."""
    with Server(program, ["--light-group", "auto", "--edge-samples", "1", *words], launcher=launcher) as server:
        client = Client(server.port)
        assert sorted(client.told("loaded")["lights"]) == ["lamp", "panel"]
        client.look()
        client.until(lambda m: isinstance(m, Frame) and m.finished)
        mean = lambda: client.ask("rectangle", "mean", rect=[0.1, 0.1, 0.9, 0.9])["luminance"]  # noqa: E731

        def under(**levels):
            client.socket.send({"type": "lights", "levels": [{"name": name, "level": level, "rgb": [1, 1, 1]} for name, level in levels.items()]})
            client.frame()
            return mean()

        whole = mean()
        lamp, panel, half = under(panel=0), under(lamp=0), under(lamp=0.5, panel=0.5)
        assert min(lamp, panel) > 0.01 * whole and abs(lamp + panel - whole) < 1e-5 * whole, (lamp, panel, whole)
        assert abs(half - whole / 2) < 1e-5 * whole, (half, whole)
        client.look(direction=[0.1, 1, 0])  # still under this mixture
        client.until(lambda m: isinstance(m, Frame) and m.view == client.ident and m.finished)
        moved = mean()
        assert abs(under() - 2 * moved) < 1e-5 * moved
        return whole, lamp, panel, moved


SUNLIT = """!gensky 9 21 {hour} +s -a 46 -o -7 -m -15
skyfunc glow sky_glow 0 0 4 1 1 1 0
sky_glow source sky 0 0 4 0 0 1 180
void plastic paint 0 0 5 {paint} 0 0
paint sphere globe 0 0 4 1.5 1 .6 .6
""" + ROOM


def changed(program, words=(), launcher=(), light=()):
    """At another hour, with another colour, and at night a view at rest is the picture of the scene whose files say so."""
    built = {"hour": "14.3", "paint": ".5 .5 .5"}
    with Server(program, ["--edge-samples", "1", *light, *words], SUNLIT.format(**built), launcher) as server:
        client = Client(server.port)
        loaded = client.told("loaded")
        assert "refused" not in loaded["time"], loaded
        client.look()
        client.until(lambda m: isinstance(m, Frame) and m.finished)

        def check(**now):
            client.until(lambda m: isinstance(m, Frame) and m.finished)
            other = server.scene.parent / "other.rad"
            other.write_text(SUNLIT.format(**{**built, **now}))
            rendered = subprocess.run([program, "render", "-ps", "1", "-pa", "0", "-x", str(SIZE[0]), "-y", str(SIZE[1]),
                                       *WORDS.split(), *light, other], stdout=subprocess.PIPE, check=True).stdout
            body = [picture.split(b"\n\n", 1)[1] for picture in (server.get("/save/picture.hdr"), rendered)]
            assert body[0] == body[1], f"the picture is another one: {now}"

        def paint(red):
            client.socket.send({"type": "edits", "id": 1, "materials": [
                {"name": "paint", "definition": 0, "kind": "plastic", "reals": [red, 0.5, 0.5, 0, 0]}]})
            return client.told("edited")

        def at(hour):
            client.socket.send({"type": "time", "time": {"month": 9, "day": 21, "hour": hour, "sky": ""}})
            told = client.told("time")
            assert "problem" not in told, told

        edited = paint(0.9)
        assert not edited["refused"] and 0.5 < edited["kept"] < 1, edited
        check(paint=".9 .5 .5")
        at(9.5)
        check(hour="9.5", paint=".9 .5 .5")
        at(2)  # night
        check(hour="2", paint=".9 .5 .5")
        at(11)
        check(hour="11", paint=".9 .5 .5")
        paint(0.2)
        check(hour="11", paint=".2 .5 .5")
        assert b"gensky 9 21 11.0000" in server.get("/save/sky.rad")


def roles(program):
    """The first drives, the second watches the same picture and may take over when the first has left."""
    with Server(program) as server:
        first = Client(server.port)
        assert first.told("welcome")["driver"]
        first.enter()
        second = Client(server.port, "fedcba9876543210")
        assert not second.told("welcome")["driver"]
        assert second.told("view")["view"]["position"] == VIEW["position"]
        second.frame()
        plan = second.ask("plan", "plan")
        assert len(zlib.decompress(base64.b64decode(plan["cells"]))) == plan["width"] * plan["height"] > 0, plan
        second.socket.send({"type": "take"})
        second.told("refused")
        first.socket.close()
        second.told("role", driver=False, driver_id=None)
        second.socket.send({"type": "take"})
        second.told("role", driver=True)
        second.look(direction=[0, 1, 0])
        second.frame(1)


def mended(program, words=(), launcher=()):
    """A scene that cannot be read says why and where; when it is mended the walk begins, or on ranks goes on."""
    wrong = ROOM + "nothing sphere wrong 0 0 4 0 0 0 1\n"
    with Server(program, words, ROOM if launcher else wrong, launcher) as server:
        client = Client(server.port)
        if launcher:
            client.enter()
            server.scene.write_text(wrong)
        failed = client.told("failed")
        assert any("room.rad:9" in line for line in failed["messages"]), failed
        late = Client(server.port, "1111111111111111")
        late.told("failed")
        late.socket.close()
        server.scene.write_text(ROOM.replace("2 2 2 0", "4 4 4 0"))
        client.told("loaded")
        client.look()
        client.until(lambda m: isinstance(m, Frame))
        picked = client.ask("pick", "picked", x=0.67, y=0.52)
        assert abs(picked["luminance"] - 716) < 0.02 * 716, picked


def followed(program):
    """Files that are edited are followed while the walk goes on: what is wrong is told, and newcomers too, until it is mended."""
    with Server(program) as server:
        client = Client(server.port)
        client.enter()
        server.scene.write_text(ROOM + "nothing sphere wrong 0 0 4 0 0 0 1\n")
        told = client.told("followed")
        assert any("room.rad:9" in line for line in told["problems"]), told
        client.look(position=[0.1, -4, 1.5])
        client.until(lambda m: isinstance(m, Frame) and m.view == client.ident)
        late = Client(server.port, "1111111111111111")
        assert late.told("followed")["problems"] == told["problems"]
        late.socket.close()
        server.scene.write_text(ROOM.replace("2 2 2 0", "4 4 4 0"))
        told = client.told("followed")
        assert not told["problems"] and (told["files"], told["materials"], told["surfaces"]) == (["room.rad"], 1, 0), told
        client.look()
        client.until(lambda m: isinstance(m, Frame) and m.view == client.ident and m.finished)
        picked = client.ask("pick", "picked", x=0.67, y=0.52)
        assert abs(picked["luminance"] - 716) < 0.02 * 716, picked
    with Server(program, ["--edge-samples", "1"]) as server:
        client = Client(server.port)
        client.enter()
        # A material; then a surface moves, and one comes before all others.
        red, dot = ROOM.replace(".5 .5 .5", ".6 .2 .1"), "grey sphere dot 0 0 4 2 3 .2 .2\n"
        for scene in (red, red.replace("-1 2 .7 .7", "-1 2.3 .7 .7").replace("grey polygon floor", dot + "grey polygon floor")):
            server.scene.write_text(scene)
            assert client.told("followed")["problems"] == []
            client.look(direction=[0.1, 1, 0])
            client.look()
            client.until(lambda m: isinstance(m, Frame) and m.view == client.ident and m.finished)
            saved = server.get("/save/picture.hdr")
            rendered = subprocess.run([program, "render", "-ps", "1", "-pa", "0", "-x", str(SIZE[0]), "-y", str(SIZE[1]), *WORDS.split(), server.scene],
                                      stdout=subprocess.PIPE, check=True).stdout
            assert saved.split(b"\n\n", 1)[1] == rendered.split(b"\n\n", 1)[1], "the pictures differ"
    with Server(program, ["--watch", "off"]) as server:
        client = Client(server.port)
        client.enter()
        server.scene.write_text(ROOM.replace("2 2 2 0", "4 4 4 0"))
        time.sleep(1.5)
        picked = client.ask("pick", "picked", x=0.67, y=0.52)
        assert abs(picked["luminance"] - 358) < 0.02 * 358, picked
        assert not any(m["type"] == "followed" for m in client.messages)


def rad_file(program, words=(), launcher=()):
    """Where the scene is named by a rad file, its changes are followed."""
    with Server(program, words, launcher=launcher, rad="scene= room.rad\nQUALITY= Low\n") as server:
        client = Client(server.port)
        client.enter()
        server.rad.write_text("scene= gone.rad\n")
        failed = client.told("failed")
        assert any("gone.rad" in line for line in failed["messages"]), failed
        (server.rad.parent / "brighter.rad").write_text(ROOM.replace("2 2 2 0", "4 4 4 0"))
        server.rad.write_text("scene= brighter.rad\nQUALITY= Low\n")
        client.told("loaded")
        client.until(lambda m: isinstance(m, Frame))
        picked = client.ask("pick", "picked", x=0.67, y=0.52)
        assert abs(picked["luminance"] - 716) < 0.02 * 716, picked


def returning(program):
    """A client that comes back finds its view."""
    with Server(program) as server:
        client = Client(server.port)
        client.told("loaded")
        client.look(position=[1, -3, 1.5])
        client.frame(1)
        client.socket.close()
        again = Client(server.port)
        welcome = again.told("welcome")
        assert welcome["view"]["position"] == [1, -3, 1.5], welcome
        other = Client(server.port, "2222222222222222")
        assert other.told("welcome")["view"]["position"] == [0, -4, 1.5]


def slow(program):
    """Behind 2 Mbit/s and 100 ms of delay frames are dropped, not queued: what is seen is never old."""
    with Server(program) as server:
        link = SlowLink(server.port, 250e3, 0.1)
        link.start()
        client = Client(link.port)
        client.enter()
        sent, waits, start = {}, [], time.monotonic()
        while (now := time.monotonic()) < start + 5:
            client.look(direction=[0.3 * (now - start) - 0.75, 1, -0.05])
            sent[client.ident] = now
            while client.socket.waits(now + 0.03 - time.monotonic()):
                taken = client.take()
                if isinstance(taken, Frame):
                    came = time.monotonic()
                    waits += [came - sent.pop(ident) for ident in list(sent) if ident <= taken.view]
        waits.sort()
        typical, late = waits[len(waits) // 2], waits[int(0.95 * len(waits))]
        print(f"slow link: from a view to its frame {1000 * typical:.0f} ms, 95 % {1000 * late:.0f} ms")
        # A timing never gates: what must not be is a queue, which would grow to seconds.
        assert late < 2, waits[-5:]


def abuse(program):
    """Nothing that a client sends or fails to send disturbs the others."""
    chance = random.Random(1)
    with Server(program, ["--clients", "4"]) as server:
        driver = Client(server.port)
        driver.enter()
        for round_ in range(100):
            misbehave(server.port, chance, f"{round_:016x}", PATIENCE)
        half_open = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(150)]
        for path in ("/../etc/passwd", "/page/none.js", "/save/other"):
            try:
                server.get(path)
                raise AssertionError(f"{path} was served")
            except urllib.error.HTTPError as error:
                assert error.code == 404, (path, error.code)
        try:
            WebSocket("127.0.0.1", server.port, origin="http://elsewhere.example").close()
            raise AssertionError("a foreign page was let in")
        except Closed as refused:
            assert "403" in str(refused), refused
        driver.look(direction=[0.2, 1, 0])
        driver.frame(driver.ident)
        assert driver.ask("pick", "picked", x=0.5, y=0.1)["hit"]
        for one in half_open:
            one.close()


def refused_beside(server, session="0123456789abcdef"):
    """Why the scene beside the walk's is refused."""
    client = Client(server.port, session, beside=True)
    reason = client.told("bye")["reason"]
    client.socket.close()
    return reason


def beside(program):
    """Who drives sees a second state of the scene, which goes with them; whatever its connection says, the walk goes on as it was."""
    chance = random.Random(2)
    with Server(program, ["--edge-samples", "1"]) as server:
        driver, watcher = Client(server.port), Client(server.port, "f" * 16)
        driver.enter()
        assert driver.messages and any(m.get("beside") == {"scene": ""} for m in driver.messages), driver.messages
        assert "who drives" in refused_beside(server, "f" * 16)
        memory = []
        for round_ in range(24):
            other = Client(server.port, beside=True)
            other.told("loaded")
            other.frame()
            if round_ == 0:
                assert "already" in refused_beside(server)
            for _ in range(chance.randrange(12)):
                other.socket.send(chance.choice([
                    {"type": "view", "id": 1, "view": VIEW, "width": 4096, "height": 4096, "moving": True, "walk": True},
                    {"type": "take"}, {"type": "hand", "to": 1}, {"type": "difference", "shown": True}, {"type": "glare", "id": 3},
                    {"type": "time", "time": {"month": 2, "day": 31, "hour": 1, "sky": ""}},
                    {"type": "edits", "id": 4, "materials": [{"name": "grey", "definition": 0, "kind": "plastic", "reals": [chance.random()] * 3 + [0, 0]}]},
                    {"type": "edits", "id": 5, "materials": [{"name": "none", "definition": 9, "kind": "glass", "reals": [-1]}]},
                    {"type": "isolux", "id": 6, "position": VIEW["position"], "height": 0.75}]))
            if round_ % 3 == 0:
                other.socket.send("garbage")
            other.socket.close()
            driver.look(direction=[0.01 * round_, 1, 0])
            driver.frame(driver.ident)
            memory.append(int(pathlib.Path(f"/proc/{server.process.pid}/statm").read_text().split()[1]))
        assert max(memory[12:]) < 1.5 * max(memory[:12]), memory
        other = Client(server.port, beside=True)
        other.frame()
        driver.socket.close()
        assert "who drives" in other.told("bye")["reason"]
        watcher.socket.send({"type": "take"})
        watcher.look()
        watcher.frame()


def ranks(program):
    """Many ranks walk as one process does, in every split. Where one is killed all end, and the client is told."""
    if not shutil.which("mpirun"):
        print("skipped: no mpirun here")
        sys.exit(77)
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", PMIX_MCA_gds="hash", ASAN_OPTIONS="detect_leaks=0:handle_sigill=1")
    sockets = tempfile.TemporaryDirectory()  # its own: others' runs of MPI may take a common one away (open-mpi/ompi issue 8510)
    mpirun = ["mpirun", "--mca", "orte_tmpdir_base", sockets.name, "--oversubscribe", "--bind-to", "none", "-n"]
    all_splits = PATIENCE <= 60  # a sanitizer takes seconds to start ranks
    rest(program, ["--variant", "ranks"], [*mpirun, "3"])
    if all_splits:
        rest(program, ["--variant", "hybrid", "-n", "2"], [*mpirun, "2"])
    alone = dimmed(program)
    for split, number in ((["--variant", "ranks"], "3"), (["--variant", "hybrid", "-n", "1"], "2"))[0 if all_splits else 1:]:
        together = dimmed(program, split, [*mpirun, number])
        assert all(abs(a - b) < 1e-6 * a for a, b in zip(alone, together)), (alone, together)
    if all_splits:
        changed(program, ["--variant", "hybrid", "-n", "2"], [*mpirun, "2"])
        mended(program, ["--variant", "hybrid", "-n", "1"], [*mpirun, "2"])
        rad_file(program, ["--variant", "hybrid", "-n", "1"], [*mpirun, "2"])
    changed(program, ["--variant", "ranks", "--scene-from", "rank0"], [*mpirun, "3"], ["-ab", "1", "-aa", "0", "-ad", "4"])
    changed(program, ["--variant", "hybrid", "-n", "1", "--scene-from", "each"], [*mpirun, "3"])
    mended(program, ["--variant", "ranks", "--scene-from", "rank0", "-ab", "1", "-ad", "64"], [*mpirun, "3"])
    with Server(program, ["--variant", "ranks"], launcher=[*mpirun, "3"]) as server:
        client = Client(server.port)
        client.enter()
        assert "many processes" in refused_beside(server)
        client.ident += 1
        client.socket.send({"type": "isolux", "id": client.ident, "position": VIEW["position"], "height": 0.75})
        assert client.told("isolux", id=client.ident, done=1)["columns"] > 0
        children = pathlib.Path(f"/proc/{server.process.pid}/task/{server.process.pid}/children").read_text().split()
        os.kill(int(children[-1]), signal.SIGKILL)
        try:
            client.until(lambda _: False)
        except (Closed, OSError):
            pass
        errors = server.process.communicate(timeout=PATIENCE)[1]
        assert server.process.returncode != 0 and "killed" in errors.lower(), errors
        server.process = subprocess.Popen(["sleep", "60"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)  # to end


CASES = {case.__name__: case for case in (rest, clean, walk_light.light, walk_light.intervals, dimmed, changed, roles, mended, followed, rad_file, returning, slow, abuse, beside, ranks)}

if __name__ == "__main__":
    for name in sys.argv[2:] or CASES:
        CASES[name](sys.argv[1])
        print(f"ok: {name}", flush=True)

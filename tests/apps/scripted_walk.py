"""`lightwalk walk` with a small room, and a client that is a script, for tests of its server."""
import os, pathlib, subprocess, sys, tempfile, time, urllib.error, urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "perf"))

from walk.misbehaviour import VIEW  # noqa: E402
from walk.websocket import Frame, WebSocket  # noqa: E402

ROOM = """void plastic grey 0 0 5 .5 .5 .5 0 0
void light lamp 0 0 3 10 10 10
void glow panel 0 0 4 2 2 2 0
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
grey sphere ball 0 0 4 -1 2 .7 .7
panel polygon screen 0 0 12  1 5.9 .5  3 5.9 .5  3 5.9 2.5  1 5.9 2.5
lamp polygon light 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
"""
WORDS = "-vtv -vp 0 -4 1.5 -vd 0 1 -.05 -vu 0 0 1 -vh 60 -vv 46.8"
SIZE = (160, 120)
PATIENCE = float(os.environ.get("LIGHTWALK_TEST_PATIENCE", "60"))  # [s]


class Server:
    """The program with a scene of its own, until the end of the block."""

    def __init__(self, program, words=(), scene=ROOM, launcher=(), rad=None):
        self.launcher = launcher
        self.folder = tempfile.TemporaryDirectory()
        self.scene = pathlib.Path(self.folder.name) / "room.rad"
        self.scene.write_text(scene)
        self.rad = None
        if rad is not None:
            self.rad = self.scene.parent / "room.rif"
            self.rad.write_text(rad)
        self.program, self.words = program, words

    def __enter__(self):
        threads = [] if "-n" in self.words else ["-n", "2"]
        self.process = subprocess.Popen([*self.launcher, self.program, "walk", "--port", "0", *threads, *WORDS.split(), *self.words, self.rad or self.scene],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder.name)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://"), self.process.stderr.read()
        self.port = int(self.address.split(":")[2].split("/")[0])
        return self

    def __exit__(self, kind, *_):
        alive = self.process.poll() is None
        self.process.terminate()
        errors = self.process.communicate(timeout=PATIENCE)[1]
        self.folder.cleanup()
        assert alive, f"the server has ended: {errors}"
        # 130, where a build is slow: it was deep in a pixel, and an interrupt waits no longer than .7 s.
        good = (0, 130) if PATIENCE > 60 else (0,)
        assert kind is not None or self.launcher or self.process.returncode in good, (self.process.returncode, errors)

    def get(self, path):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}{path}", timeout=PATIENCE) as answer:
            return answer.read()


class Client:
    def __init__(self, port, session="0123456789abcdef", host="127.0.0.1", token="", **more):
        self.socket = WebSocket(host, port, f"/walk?token={token}" if token else "/walk", timeout=PATIENCE)
        self.ident, self.messages = 0, []
        self.socket.send({"type": "hello", "session": session, **more})

    def look(self, **changes):
        self.ident += 1
        self.socket.send({"type": "view", "id": self.ident, "view": {**VIEW, **changes}, "width": SIZE[0], "height": SIZE[1],
                          "moving": False, "walk": False})

    def enter(self):
        """Once the scene is there: the first picture."""
        self.told("loaded")
        self.look()
        self.frame(1)

    def take(self):
        message = self.socket.receive()
        if isinstance(message, bytes):
            frame = Frame(message)
            self.socket.send({"type": "ack", "frame": frame.number})
            return frame
        self.messages.append(message)
        return message

    def until(self, wanted):
        """The next message or frame of which wanted() is true."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            taken = self.take()
            if wanted(taken):
                return taken
        raise AssertionError(f"nothing came of what was waited for; the last messages: {self.messages[-3:]}")

    def told(self, kind, **fields):
        return self.until(lambda m: isinstance(m, dict) and m["type"] == kind and all(m.get(k) == v for k, v in fields.items()))

    def frame(self, view=0):
        return self.until(lambda m: isinstance(m, Frame) and m.view >= view)

    def ask(self, kind, answer, **fields):
        self.ident += 1
        self.socket.send({"type": kind, "id": self.ident, **fields})
        return self.told(answer, id=self.ident)

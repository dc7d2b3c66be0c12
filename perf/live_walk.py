#!/usr/bin/python3
"""Measures how `lightwalk walk` keeps up with a client that moves: frames a second, and the time from a view to its frame.

  perf/run.sh walk [--scenes DIR] [--seconds 20] [--sizes 640x480,1280x720]     builds, then this
  live_walk.py --lightwalk PROGRAM ...

Starts the server, connects by a WebSocket as the page does, sends sixty views a second of a turn and of a walk forward
and back, and acknowledges each frame when it is there (a page does so when it is drawn). With --plain it is a page that shows
frames as they come; else one that draws the camera from them, and is sent depths, too. One line a walk:

  fps         frames a second that reached the client
  latency     from sending a view to the first frame that shows it or a newer one: median, 95th percentile [ms]
  reused      share of the pixels that points answered, as the server tells [%]
  inferred    share of the pixels with colours from around them on their own surface, as the server tells [%]
  guessed     share of the pixels that were filled from around, as the server tells [%]
  width       of the frames, mean share of what was asked for: moving frames are smaller where time is short [%]
  Mbit/s      of frames

Where the scene has dimmers (--options "--light-group auto") a third line, `dim`: the view rests, all its pixels are traced, and one after the
other the dimmers are drawn to and fro, sixty levels a second. The latency is from sending a level to the next frame.
Where a generator makes the scene's sky one more, `hours`: the view rests, and the hour is drawn from nine to five and back, sixty times a
second. The rate is of pictures at other hours; the latency is from sending an hour to the next frame. Then the hand lets go. Where there is
indirect light (--options "-ab 1") a line `after` says how long until the picture is whole in size, until all of it shows indirect light, be
it a draft, until its direct light is exact, and until all is but for finer edges; as the server tells, four times a second [s].

With --rate the client is behind a link that carries so many Mbit/s, and with --delay behind a round trip of so many ms. What waits on
the way, in a queue of the server's or of the link's, comes on top of the delay in `latency`.

With --abuse each walk is measured again while another process holds 200 half-open connections and sends a thousand
random and malformed messages a second: its share of the frames a second, and how many messages there were.
"""
import argparse, json, math, multiprocessing, os, pathlib, queue, shlex, subprocess, sys, threading, time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE / "scaling"))

from walk import stage, views  # noqa: E402
from walk.misbehaviour import keep_misbehaving  # noqa: E402
from walk.slow_link import SlowLink  # noqa: E402
from walk.websocket import Closed, Frame, WebSocket  # noqa: E402

SETTLE = 6  # before moving: the first picture [s]
MOST_REST = 60  # until all pixels are traced [s]


def as_message(view, ident, size, moving=True):
    return {"type": "view", "id": ident, "width": size[0], "height": size[1], "moving": moving, "walk": False, "view": view}


def page_view(view):
    """A view of views.parse as the page says it."""
    return {"type": view["type"], "position": view["-vp"], "direction": view["-vd"], "up": view["-vu"],
            "horizontal": view["-vh"][0], "vertical": view["-vv"][0]}


def view_of(place, client, size):
    """Where a walk begins, as the page says it, and its pace: eyes are as high as a person's, whatever the scene's unit is."""
    view = page_view(views.parse((place.program.scene.folder / place.file).read_text()))
    vertical = 2 * math.degrees(math.atan(math.tan(math.radians(view["horizontal"]) / 2) * size[1] / size[0]))
    return {**view, "vertical": vertical, "pace": client.loaded["eye_height"] / 1.6}


def turned(view, degrees):
    angle, (x, y, z) = math.radians(degrees), view["direction"]
    return {**view, "direction": [x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle), z]}


def advanced(view, way):
    x, y, z = view["direction"]
    size = math.hypot(x, y)
    position = view["position"]
    return {**view, "position": [position[0] + way * x / size, position[1] + way * y / size, position[2]]}


#: View after so many seconds: a slow look around, thirty degrees a second; half a pace a second, there and back.
WALKS = {"turn": lambda view, t: turned(view, 30 * t),
         "walk": lambda view, t: advanced(view, 0.7 * (1 - abs(t % 4 - 2) / 2) * view["pace"])}


class Server:
    def __init__(self, place, words, launcher):
        self.process = subprocess.Popen([*launcher, place.program.lightwalk, "walk", "--port", "0", "--quiet", *words, "-vf", place.file, *map(str, stage.AMBIENT),
                                         *place.program.scene.words], cwd=place.program.scene.folder,
                                        env={**os.environ, "RAYPATH": ".:../lib"}, stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            sys.exit("the server does not start")
        self.port = int(self.address.split(":")[2].split("/")[0])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(20)


class Client:
    def __init__(self, port, size, plain):
        self.port, self.socket, self.size = port, WebSocket("127.0.0.1", port), size
        self.ident, self.finished = 0, False
        self.forget()
        self.loaded = None
        # Beside what is sent: a message takes its time on a slow link, and whoever waits for its end says no view meanwhile.
        self.messages = queue.SimpleQueue()
        self.socket.socket.settimeout(None)
        threading.Thread(target=self.receive, daemon=True).start()
        self.socket.send({"type": "hello", "session": "0123456789abcdef", "depth": not plain,
                          "luminance": True})

    def look(self, view, moving=True):
        self.ident += 1
        self.sent[self.ident] = time.monotonic()
        view = {name: value for name, value in view.items() if name != "pace"}
        self.socket.send(as_message(view, self.ident, self.size, moving))

    def receive(self):
        try:
            while True:
                self.messages.put(self.socket.receive())
        except (Closed, OSError) as end:
            self.messages.put(end)

    def listen(self, until):
        while (left := until - time.monotonic()) > 0:
            try:
                message = self.messages.get(timeout=left)
            except queue.Empty:
                return
            if isinstance(message, Exception):
                raise message
            self.take(message)

    def take(self, message):
        if not isinstance(message, bytes):
            if message["type"] == "state":
                self.reuse.append(message["reuse"])
                self.guessed.append(message.get("guessed", 0))  # servers of before do not tell
                self.inferred.append(message.get("inferred", 0))
                self.states.append((time.monotonic(), message))
            elif message["type"] == "failed":
                sys.exit("\n".join(message["messages"]))
            elif message["type"] == "loaded":
                self.loaded = message
            elif message["type"] == "time":
                self.hours += 1
            return
        frame = Frame(message)
        self.socket.send({"type": "ack", "frame": frame.number})
        self.frames += 1
        self.finished = frame.finished
        self.bytes += frame.bytes
        self.width += frame.width
        self.widths.append((time.monotonic(), frame.width))
        now = time.monotonic()
        for ident in [ident for ident in self.sent if ident <= frame.view or self.dims]:
            self.latency.append(now - self.sent.pop(ident))

    def forget(self):
        self.sent, self.frames, self.latency, self.bytes, self.reuse, self.width = {}, 0, [], 0, [], 0
        self.inferred, self.guessed, self.dims, self.hours = [], [], False, 0
        self.states, self.widths = [], []

    def dim(self, name, level):
        self.ident += 1
        self.sent[self.ident], self.dims = time.monotonic(), True
        self.socket.send({"type": "lights", "levels": [{"name": name, "level": level, "rgb": [1, 1, 1]}]})

    def set_hour(self, hour):
        self.ident += 1
        self.sent[self.ident], self.dims = time.monotonic(), True
        self.socket.send({"type": "time", "time": {**self.loaded["time"]["time"], "hour": hour}})


def port_behind(port, args):
    """The port of the server, or that of a link to it."""
    if args.rate == math.inf and args.delay == 0:
        return port
    link = SlowLink(port, args.rate * 125e3, args.delay / 1000)
    link.start()
    return link.port


def mean_percent(shares):
    return 100 * sum(shares) / max(len(shares), 1)


def measure(client, view, walk, seconds):
    client.look(view)
    client.listen(time.monotonic() + SETTLE)
    client.forget()
    start = time.monotonic()
    while (now := time.monotonic()) < start + seconds:
        client.look(WALKS[walk](view, now - start))
        client.listen(now + 1 / 60)
    return figures(client, time.monotonic() - start)


def rest(client, view):
    """Until all of the view's pixels are traced."""
    client.look(view, moving=False)
    client.finished = False
    end = time.monotonic() + MOST_REST
    while not client.finished and time.monotonic() < end:
        client.listen(time.monotonic() + 0.1)
    client.forget()


def measure_hours(client, view, seconds):
    """Pictures of a view at rest while the sun moves."""
    rest(client, view)
    start = time.monotonic()
    while (now := time.monotonic()) < start + seconds:
        client.set_hour(17 - 8 * abs(1 - (now - start) / 4 % 2))
        client.listen(now + 1 / 60)
    found = figures(client, time.monotonic() - start)
    return {**found, "fps": min(client.frames, client.hours) / (time.monotonic() - start)}


def measure_after(client, view, seconds):
    """How long after another hour until its light is there."""
    measure_hours(client, view, min(seconds, 2))
    client.forget()
    start, client.finished = time.monotonic(), False
    client.set_hour(15)
    refined = lambda: [state for _, state in client.states[-1:] if state["phase"] in ("refining", "done")]
    while not refined() and time.monotonic() < start + MOST_REST:
        client.listen(time.monotonic() + 0.1)

    def first(happened, found):
        return min((when - start for when, what in happened if found(what)), default=math.inf)
    whole = first(client.widths, lambda width: width == client.size[0])
    states = [(when, state) for when, state in client.states if when - start >= whole]
    is_lit = lambda state: state["phase"] in ("refining", "done")
    return {"whole size s": whole,
            "indirect s": first(states, lambda state: state.get("inferred", 0) > 0 or state["phase"] == "ambient" and state["share"] > 0 or is_lit(state)),
            "direct exact s": first(states, lambda state: state["phase"] == "ambient" or is_lit(state)), "exact s": first(states, is_lit)}


def measure_dimming(client, view, seconds):
    """Frames of a view at rest while its lights change."""
    rest(client, view)
    names = client.loaded["lights"]
    start = time.monotonic()
    while (now := time.monotonic()) < start + seconds:
        t = now - start
        client.dim(names[int(t) % len(names)], abs(1 - 2 * (t % 1)))
        client.listen(now + 1 / 60)
    return figures(client, time.monotonic() - start)


def figures(client, took):
    waits = sorted(client.latency) or [math.inf]
    return {"fps": client.frames / took, "latency ms": 1000 * waits[len(waits) // 2],
            "95 % ms": 1000 * waits[int(0.95 * (len(waits) - 1))],
            "reused %": mean_percent(client.reuse), "inferred %": mean_percent(client.inferred),
            "guessed %": mean_percent(client.guessed),
            "width %": 100 * client.width / max(client.frames, 1) / client.size[0], "Mbit/s": 8e-6 * client.bytes / took}


def measure_abused(client, view, walk, seconds, quiet):
    counts = multiprocessing.Value("L", 0)
    abuser = multiprocessing.Process(target=keep_misbehaving, args=(client.port, counts), daemon=True)
    abuser.start()
    try:
        return {"abused": measure(client, view, walk, seconds)["fps"] / quiet, "messages": counts.value}
    finally:
        abuser.terminate()
        abuser.join()


def parse_args():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=lambda text: pathlib.Path(text).resolve(), metavar="DIR")
    parser.add_argument("--lightwalk", default=HERE.parent / "build/release/lightwalk", metavar="PROGRAM")
    parser.add_argument("--views", default="cabin/living,cabin/interior,lodge/living")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--sizes", default="640x480,1280x720")
    parser.add_argument("--options", default="", help="more options of walk, in one word")
    parser.add_argument("--rate", type=float, default=math.inf, help="of the link [Mbit/s]")
    parser.add_argument("--delay", type=float, default=0, help="of a round trip [ms]")
    parser.add_argument("--launcher", default="", help='for example "mpirun -n 2"')
    parser.add_argument("--plain", action="store_true")
    parser.add_argument("--abuse", action="store_true")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE")
    return parser.parse_args()


def main():
    args = parse_args()
    rows = []
    for place in stage.places(args.views.split(","), args.lightwalk, args.scenes):
        for size in [tuple(int(word) for word in text.split("x")) for text in args.sizes.split(",")]:
            with Server(place, args.options.split(), shlex.split(args.launcher)) as server:
                client = Client(port_behind(server.port, args), size, args.plain)
                while client.loaded is None:
                    client.listen(time.monotonic() + 0.1)
                view = view_of(place, client, size)
                others = {"dim": measure_dimming if client.loaded.get("lights") else None,
                          "hours": measure_hours if "refused" not in (client.loaded.get("time") or {"refused": ""}) else None}
                if others["hours"] and "-ab" in args.options:
                    others["after"] = measure_after
                for walk in [*WALKS, *(name for name, known in others.items() if known)]:
                    found = measure(client, view, walk, args.seconds) if walk in WALKS else others[walk](client, view, args.seconds)
                    row = {"view": place.name, "size": f"{size[0]}x{size[1]}", "walk": walk, **found}
                    if args.abuse and walk in WALKS:
                        row.update(measure_abused(client, view, walk, args.seconds, row["fps"]))
                    if not rows:
                        print("\t".join(row))
                    rows.append(row)
                    named = lambda name, value: f"{name} {value}" if name not in rows[0] else value
                    print("\t".join(named(name, f"{value:.3g}" if isinstance(value, float) else str(value)) for name, value in row.items()), flush=True)
    if args.json:
        args.json.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()

"""A long random walk that tests whether the program's memory grows, or the program crashes."""
import json, pathlib, subprocess, threading, time

from . import stage, views

#: Corners of boxes inside the rooms, at the height of eyes [m]; the cabin's are feet.
ROOMS = {"cabin": ((13, 2, 4), (25, 15, 6)), "lodge": ((1.5, 1, 1.2), (8.5, 5.5, 1.9))}


def resident(process):
    """Memory of a process that is in use [bytes]; 0 when it has ended."""
    try:
        status = pathlib.Path(f"/proc/{process}/status").read_text()
    except OSError:
        return 0
    found = [line.split()[1] for line in status.split("\n") if line.startswith("VmRSS:")]
    return 1024 * int(found[0]) if found else 0


def growth(samples):
    """How much more memory was in use at most during the last tenth of the frames than during the second tenth, as a
    share.

    samples  (frames drawn, bytes), in order: the first tenth is for what is fetched once
    """
    last = samples[-1][0]
    early = max((memory for drawn, memory in samples if 0.1 * last <= drawn <= 0.2 * last), default=samples[0][1])
    late = max(memory for drawn, memory in samples if drawn >= 0.9 * last)
    return (late - early) / early


def faults(found, most_growth):
    """A sentence for each failure; an empty list when there is none. See soak()."""
    said = []
    if found["status"] != 0:
        said.append(f"the program ended with {found['status']}: {found.get('message', '')}")
    if found["drawn"] != found["frames"]:
        said.append(f"{found['drawn']} frames of {found['frames']} were drawn")
    if found["growth"] > most_growth:
        said.append(f"memory grew by {found['growth']:.1%} after the first tenth, allowed are {most_growth:.1%}")
    if found["points"] > found["limit"]:
        said.append(f"the cloud held {found['points']} points, allowed are {found['limit']}")
    return said


class Sweeper(threading.Thread):
    """A thread that deletes frames as they are written, and records their number and the memory in use once a second."""

    def __init__(self, folder, process):
        super().__init__(daemon=True)
        self.folder, self.process = folder, process
        self.drawn, self.samples, self.done = 0, [], threading.Event()

    def sweep(self):
        for path in self.folder.glob("f*.hdr"):
            path.unlink()
            self.drawn += 1

    def run(self):
        while not self.done.wait(1):
            self.sweep()
            memory = resident(self.process)
            if memory and self.drawn:
                self.samples.append((self.drawn, memory))

    def end(self):
        self.done.set()
        self.join()
        self.sweep()


def path_of(room, frames, seed):
    """A walk through a room, a key every 25 frames."""
    return views.random_walk(*ROOMS[room], max(2, frames // 25), seed)


def soak(place, size, seed, limit, folder, words=()):
    """Walk through a room. Returns what happened: frames that were wanted and drawn, seconds, the exit status, memory
    by frames drawn, its growth, and the most points with what is allowed, --cloud-limit times the pixels."""
    folder.mkdir(parents=True, exist_ok=True)
    path, stats = folder / "walk.vf", folder / "stats.json"
    path.write_text(views.lines(path_of(place.program.scene.name, size.frames, seed)))
    command = [place.program.lightwalk, "animate", "--quiet", *stage.picture_words(size), "--path", path, "--frames",
               size.frames, "--cloud-limit", limit, *words, "--stats", stats, "-o", folder / "f%05d.hdr",
               *place.program.scene.words]
    begin = time.monotonic()
    with open(folder / "messages", "wb") as messages:
        process = subprocess.Popen([str(word) for word in command], cwd=place.program.scene.folder,
                                   env=place.program.environment, stdin=subprocess.DEVNULL, stderr=messages)
        sweeper = Sweeper(folder, process.pid)
        sweeper.start()
        try:
            status = process.wait()
        except BaseException:  # nobody waits any more
            process.terminate()
            process.wait()
            raise
        finally:
            sweeper.end()
    found = {"frames": size.frames, "drawn": sweeper.drawn, "status": status, "seconds": time.monotonic() - begin,
             "message": (folder / "messages").read_text(errors="replace")[-500:], "samples": sweeper.samples,
             "growth": growth(sweeper.samples) if len(sweeper.samples) >= 20 else 0.0, "points": 0, "limit": 0}
    if status == 0:
        told = json.loads(stats.read_text())
        found["points"] = max(frame["points"] for frame in told["reuse"]["frames"])
        found["limit"] = round(limit * told["picture"]["width"] * told["picture"]["height"])
        found["reused"], found["peak"] = told["reuse"]["reused"], told["peak_memory_bytes"]
    return found

#!/usr/bin/python3
"""Measures how a walk's light follows its changes, in one process and on ranks: the hour, and an edited material.

  live_changes.py --lightwalk PROGRAM [--scenes DIR] [--views lodge/living] [--size 640x480] [--seconds 6] [--edits 5] [--at .5,.3] [--ranks 2]

DIR holds Radiance's sample models; the demo scene needs none. Each view is measured by one process on all cores and, where mpirun is there, by
--ranks ranks that share them, at rest, as a page that draws the camera, with one bounce of indirect light. Columns:

  hours a second   pictures at another hour while the hour is drawn from nine to five and back, sixty times a second
  hour, 95 %       from sending an hour to the next frame: median, 95th percentile [ms]
  indirect, exact  after the last hour: until all of the picture shows indirect light, be it a draft, and until its direct light is exact [s]
  edit, worst      from sending another number of the material that the picture has at --at to the first frame of it: median, greatest [ms]
  kept             share of the points that the last edit has left standing

The first frame after an edit has each pixel that may show the material traced or left out: none is as it was before.
"""
import argparse, os, pathlib, shutil, statistics, time

import live_walk
from walk import stage

DRAWN = 1.2  # what one edit is given until the next one [s]
LATEST = 5  # for its first frame [s]


class ChangingClient(live_walk.Client):
    """One that keeps the newest message of each type, with the time at which it was there."""

    def __init__(self, port, size):
        self.newest = {}
        super().__init__(port, size, plain=False)

    def take(self, message):
        if not isinstance(message, bytes):
            self.newest[message["type"]] = (time.monotonic(), message)
        super().take(message)

    def wait_for(self, happened, seconds):
        end = time.monotonic() + seconds
        while not happened() and time.monotonic() < end:
            self.listen(time.monotonic() + 0.002)
        return happened()


def editable_layer(client, at):
    """The first part of the material at a point of the picture that has numbers to change."""
    client.socket.send({"type": "material", "id": 1, "x": at[0], "y": at[1]})
    if not client.wait_for(lambda: "material" in client.newest, LATEST):
        raise SystemExit("the server does not tell the material")
    layers = client.newest["material"][1]["layers"]
    return next(layer for layer in layers if not layer.get("fixed") and layer.get("reals"))


def measure_edits(client, view, at, edits):
    live_walk.rest(client, view)
    layer = editable_layer(client, at)
    waits = []
    for k in range(edits):
        first = layer["reals"][0]
        reals = [first + (0.4 if first < 0.5 else -0.4) * (k + 1) / edits, *layer["reals"][1:]]
        material = {**{name: layer[name] for name in ("name", "definition", "kind")}, "reals": reals}
        begin = time.monotonic()
        client.newest.pop("edited", None)
        client.socket.send({"type": "edits", "id": 2 + k, "materials": [material]})
        # What is drawn meanwhile is still of the material before.
        if not client.wait_for(lambda: "edited" in client.newest, LATEST):
            raise SystemExit("the server does not take the edit")
        if refused := client.newest["edited"][1]["refused"]:
            raise SystemExit(refused[0]["why"])
        frames = client.frames
        client.wait_for(lambda: client.frames > frames, LATEST)
        waits.append(1000 * (time.monotonic() - begin))
        client.listen(time.monotonic() + DRAWN)
    return {"edit ms": statistics.median(waits), "worst ms": max(waits), "kept": client.newest["edited"][1].get("kept", -1)}


def measure(place, size, launch, threads, args):
    with live_walk.Server(place, ["-n", str(threads), "-ab", "1"], launch) as server:
        client = ChangingClient(server.port, size)
        client.wait_for(lambda: client.loaded, live_walk.MOST_REST)
        view = live_walk.view_of(place, client, size)
        row = {}
        if "refused" not in (client.loaded.get("time") or {"refused": ""}):
            hours = live_walk.measure_hours(client, view, args.seconds)
            after = live_walk.measure_after(client, view, args.seconds)
            row = {"hours a second": hours["fps"], "hour ms": hours["latency ms"], "95 % ms": hours["95 % ms"],
                   "indirect s": after["indirect s"], "exact s": after["direct exact s"]}
        return {**row, **measure_edits(client, view, args.at, args.edits)}


def main():
    point = lambda text: tuple(float(word) for word in text.split(","))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lightwalk", type=os.path.abspath, required=True, metavar="PROGRAM")
    parser.add_argument("--scenes", type=lambda text: pathlib.Path(text).resolve(), metavar="DIR")
    parser.add_argument("--views", default="lodge/living")
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--seconds", type=float, default=6)
    parser.add_argument("--edits", type=int, default=5)
    parser.add_argument("--at", type=point, default=(0.5, 0.3), help="from the left and the bottom")
    parser.add_argument("--ranks", type=int, default=2)
    args = parser.parse_args()
    size = tuple(int(word) for word in args.size.split("x"))
    cores = os.cpu_count()
    os.environ.update(PMIX_MCA_gds="hash", **({} if os.getuid() else {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}))
    splits = [(f"1 x {cores}", [], cores)]
    if args.ranks > 1 and shutil.which("mpirun"):
        threads = max(1, cores // args.ranks)
        splits.append((f"{args.ranks} x {threads}", ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(args.ranks)], threads))
    for place in stage.places(args.views.split(","), args.lightwalk, args.scenes):
        for name, launch, threads in splits:
            row = measure(place, size, launch, threads, args)
            print(place.name, name, *(f"{what} {value:.3g}" for what, value in row.items()), sep="\t", flush=True)


if __name__ == "__main__":
    main()

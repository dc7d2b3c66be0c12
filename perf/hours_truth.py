#!/usr/bin/python3
"""At another hour a walk at rest shows the picture that `lightwalk render` makes of files that name that hour.

  hours_truth.py --lightwalk PROGRAM [--scenes DIR] [--hours 8,10.5,15,17.5]

The demo scene, the cabin (of the sample models in DIR) and an office of lamps, each under a sky of gensky's. A line a picture: its bytes are
the same, or how many are not. Status 1 where some are not."""
import argparse
import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import urllib.request

import live_walk
from walk import stage

SIZE = (320, 240)
CABIN = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad summerday landscape lights.off daywindows".split()
SKY = "\n!gensky 9 21 11 +s -a 46 -o -7 -m -15\nskyfunc glow above 0 0 4 1 1 1 0\nabove source sky 0 0 4 0 0 1 180\n"
GENSKY = re.compile(r"(?m)^!gensky.*$")


def get(server, path):
    return urllib.request.urlopen(f"http://127.0.0.1:{server.port}{path}").read()


def at_hour(folder, words, sky, made):
    """The scene's files, where gensky is called by others in `made` that call it as `sky` says."""
    call = "!" + re.search(r"gensky [^\n]*", sky)[0]
    named = []
    for word in words:
        text = (folder / word).read_text() if (folder / word).is_file() else ""
        if GENSKY.search(text):
            word = pathlib.Path(made) / word.replace("/", "_")
            word.write_text(GENSKY.sub(call, text))
        named.append(word)
    return named


def differing(place, hours, made):
    """Says how each picture is; the number of those that differ."""
    folder, program = place.program.scene.folder, place.program.lightwalk
    wrong = 0
    with live_walk.Server(place, ["--edge-samples", "1", "-ps", "1"], []) as server:
        client = live_walk.Client(server.port, SIZE, False)
        while client.loaded is None:
            client.listen(time.monotonic() + 0.1)
        view = {**live_walk.page_view(live_walk.views.parse((folder / place.file).read_text())), "pace": 1}
        live_walk.rest(client, view)
        for hour in hours:
            client.set_hour(hour)
            client.listen(time.monotonic() + 1)
            live_walk.rest(client, view)
            seen = get(server, "/save/picture.hdr").split(b"\n\n", 1)[1]
            files = at_hour(folder, place.program.scene.words, get(server, "/save/sky.rad").decode(), made)
            words = ["-vf", place.file, "-x", SIZE[0], "-y", SIZE[1], "-pa", 0, "-ps", 1, *stage.AMBIENT, "--quiet", *files]
            drawn = subprocess.run([program, "render", *map(str, words)], cwd=folder, env={**os.environ, "RAYPATH": ".:../lib"},
                                   stdout=subprocess.PIPE, check=True).stdout.split(b"\n\n", 1)[1]
            off = sum(a != b for a, b in zip(seen, drawn)) + abs(len(seen) - len(drawn))
            print(f"{place.name} at {hour:g}: {'the same bytes' if off == 0 else f'{off} of {len(drawn)} bytes differ'}", flush=True)
            wrong += off > 0
    return wrong


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--lightwalk", type=pathlib.Path, required=True)
    options.add_argument("--scenes", type=pathlib.Path)
    options.add_argument("--hours", default="8,10.5,15,17.5")
    given = options.parse_args()
    live_walk.MOST_REST = 60
    wrong = 0
    with tempfile.TemporaryDirectory() as made:
        for place in stage.places(["lodge/living", "cabin/living", "office/glass"], given.lightwalk.resolve(), given.scenes, pathlib.Path(made)):
            scene = place.program.scene
            if place.name.startswith("cabin"):
                place = dataclasses.replace(place, program=stage.Program(place.program.lightwalk, dataclasses.replace(scene, words=tuple(CABIN))))
            if place.name.startswith("office"):
                office = scene.folder / "office.rad"
                office.write_text(office.read_text() + SKY)
            wrong += differing(place, [float(hour) for hour in given.hours.split(",")], made)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

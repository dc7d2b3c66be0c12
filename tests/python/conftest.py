"""Tests of the Python package as it is installed: run_tests.py makes it ready."""

import os
import pathlib
import subprocess
import sys

import pytest

import lightwalk

os.environ.pop("LD_PRELOAD", None)  # of a sanitizer, for this process: a shell crashes with it

PROGRAM = pathlib.Path(lightwalk.__file__).parent / "bin" / "lightwalk"

ROOM = """void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic shiny 0 0 5 .4 .3 .2 .1 .05
void light lamp 0 0 3 10 9 8
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
grey polygon ceiling 0 0 12  -4 -6 3  -4 6 3  4 6 3  4 -6 3
shiny sphere ball 0 0 4 -1 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
"""
VIEW = lightwalk.View((0, -4, 1.5), (0, 1, -.05), horizontal=60, vertical=46.8)
VIEW_WORDS = ["-vtv", "-vp", "0", "-4", "1.5", "-vd", "0", "1", "-.05", "-vu", "0", "0", "1", "-vh", "60", "-vv", "46.8"]


def command(*words, input=None):
    """What the program writes to standard output."""
    done = subprocess.run([PROGRAM, *map(str, words)], input=input, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout


def in_new_process(code, *words, timeout=600):
    """What a script prints."""
    preload = {"LD_PRELOAD": os.environ["LIGHTWALK_PRELOAD"]} if "LIGHTWALK_PRELOAD" in os.environ else {}
    done = subprocess.run([sys.executable, "-c", code, *map(str, words)], capture_output=True, text=True, timeout=timeout, check=False,
                          env={**os.environ, **preload})
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def room_file(tmp_path_factory):
    file = tmp_path_factory.mktemp("scene") / "room.rad"
    file.write_text(ROOM)
    return file


@pytest.fixture(scope="session")
def room(room_file):
    return lightwalk.Scene.from_files(room_file)

#!/usr/bin/python3
"""Every call that a walk's head needs to begin fails once: it ends with a message and status 1 before any rank is left behind, or the page is served all the same.

usage: failing_launch_test.py LIGHTWALK

Skipped (77) where strace or mpirun is not installed, or strace may not watch."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "apps"))

from launched_walk_test import PATIENCE, children, free_port, ranks_of, soon, visit  # noqa: E402
from scripted_walk import ROOM, WORDS  # noqa: E402
from walk.websocket import Closed  # noqa: E402

SKIPPED = 77
# An error of each, and how many calls of the head's first thread are tried.
CALLS = {"pipe2": ("EMFILE", 3), "signalfd4": ("EMFILE", 1), "clone3": ("EAGAIN", 2), "clone": ("EAGAIN", 1), "socket": ("EMFILE", 1),
         "bind": ("EADDRINUSE", 1), "listen": ("EADDRINUSE", 1), "epoll_create1": ("EMFILE", 2), "eventfd2": ("EMFILE", 2),
         "timerfd_create": ("EMFILE", 2)}


def skip(why):
    print("skipped:", why)
    sys.exit(SKIPPED)


def check(program, scene, folder, call, error, index):
    port = free_port()
    mpirun = f"--oversubscribe --bind-to none --mca orte_tmpdir_base {folder}"
    traced = ["strace", "-qq", "-o", os.devnull, "-e", f"trace={call}", "-e", "signal=none", "-e", f"inject={call}:error={error}:when={index}"]
    launch = subprocess.Popen([*traced, program, "launch", "--ranks", "1", "--mpirun", mpirun, "walk", "--port", str(port), "-n", "1", *WORDS.split(), scene],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    what = f"{call} number {index} fails with {error}"
    served = False
    try:
        if launch.stdout.readline():
            visit(port).told("loaded")
            served = True
            for child in children(launch.pid):
                os.kill(child, signal.SIGTERM)
    except (OSError, Closed):  # it has ended
        pass
    errors = launch.communicate(timeout=PATIENCE)[1]
    if "PTRACE" in errors.upper():
        skip(errors.splitlines()[0])
    assert served or launch.returncode == 1 and errors.strip(), f"{what}: status {launch.returncode}, {errors!r}"
    soon(lambda: not ranks_of(port), f"{what}: ranks are left")
    return served


def main(program):
    for tool in "strace", "mpirun":
        if not shutil.which(tool):
            skip(f"no {tool} here")
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "room.rad"
        scene.write_text(ROOM)
        tried = [check(program, scene, folder, call, error, index) for call, (error, count) in CALLS.items() for index in range(1, count + 1)]
    assert not all(tried), "no call has failed"
    print(f"{len(tried)} failing calls, the page was served all the same after {sum(tried)}")
    return 0


if __name__ == "__main__":
    sys.exit(main(os.path.realpath(sys.argv[1])))

#!/usr/bin/python3
"""Every call that a walk's head needs to begin fails once: it ends with a message and status 1 before any rank is left behind, or the page is served all the same.
So do calls of its threads later, while a run is lost and begins anew, or somebody opens the page.

usage: failing_launch_test.py LIGHTWALK [all]

all: more calls, and more errors.

Skipped (77) where strace or mpirun is not installed, or strace may not watch."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "apps"))

from launched_walk_test import PATIENCE, children, free_port, ranks_of, soon, visit  # noqa: E402
from scripted_walk import ROOM, WORDS  # noqa: E402
from walk.websocket import Closed  # noqa: E402

SKIPPED = 77
# An error of each, and how many calls of the head's first thread are tried.
CALLS = {"pipe2": ("EMFILE", 3), "signalfd4": ("EMFILE", 1), "clone3": ("EAGAIN", 2), "clone": ("EAGAIN", 1), "socket": ("EMFILE", 1),
         "bind": ("EADDRINUSE", 1), "listen": ("EADDRINUSE", 1), "epoll_create1": ("EMFILE", 2), "eventfd2": ("EMFILE", 2),
         "timerfd_create": ("EMFILE", 2)}
# Of a head that has a run: by which of its threads, an error, how many of them, and whether one that is not called is a mistake here.
LATER = [("links", "clone3", "EAGAIN", 1, True), ("starter", "pipe2", "EMFILE", 1, True), ("starter", "clone", "EAGAIN", 1, True),
         ("server", "accept4,accept", "EMFILE", 1, True), ("server", "epoll_ctl", "ENOMEM", 1, True), ("server", "recvmsg", "ECONNRESET", 1, True),
         ("server", "sendmsg", "EPIPE", 1, True), ("links", "socket", "EMFILE", 1, True), ("links", "connect", "ECONNREFUSED", 1, True),
         ("links", "epoll_ctl", "ENOSPC", 1, True), ("links", "recvmsg", "ECONNRESET", 1, True), ("links", "sendmsg", "EPIPE", 1, True)]
MORE = [("starter", "pipe2", "ENFILE", 3, True), ("starter", "read", "EIO", 4, True), ("starter", "poll", "ENOMEM", 2, True),
        ("starter", "write", "EIO", 3, True), ("server", "accept4,accept", "ENFILE", 2, False), ("server", "accept4,accept", "ECONNABORTED", 2, False),
        ("server", "accept4,accept", "ENOMEM", 1, True), ("server", "epoll_ctl", "ENOSPC", 4, False), ("server", "recvmsg", "ENOMEM", 4, False),
        ("server", "sendmsg", "ECONNRESET", 6, False), ("server", "setsockopt", "ENOBUFS", 3, False), ("server", "ioctl", "EIO", 3, False),
        ("server", "timerfd_settime", "EINVAL", 3, False), ("server", "epoll_wait", "EINTR", 2, True), ("server", "write", "EIO", 2, False),
        ("server", "getpeername", "ENOTCONN", 1, False), ("links", "epoll_wait", "EINTR", 2, True), ("links", "setsockopt", "ENOBUFS", 3, False),
        ("links", "ioctl", "EIO", 3, False), ("links", "epoll_ctl", "ENOMEM", 4, False), ("links", "recvmsg", "ENOMEM", 6, False), ("links", "sendmsg", "ENOBUFS", 6, False),
        ("links", "timerfd_settime", "EINVAL", 3, False), ("links", "write", "EIO", 2, False), ("links", "getrandom", "ENOSYS", 1, False)]


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


class Head:
    """A walk's head with a run of one rank."""

    def __init__(self, program, scene, folder):
        self.port, self.failed = free_port(), ""
        mpirun = f"--oversubscribe --bind-to none --mca orte_tmpdir_base {folder}"
        self.launch = subprocess.Popen([program, "launch", "--ranks", "1", "--retries", "1000", "--mpirun", mpirun, "walk", "--port", str(self.port), "-n", "1",
                                        *WORDS.split(), scene], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.launch.stdout.readline(), self.launch.communicate()

    def thread(self, name):
        """Its number; they are begun in this order."""
        threads = sorted(int(task.name) for task in pathlib.Path(f"/proc/{self.launch.pid}/task").iterdir())
        return threads[["starter", "links", "server"].index(name)]

    def serves(self, what):
        """Whether somebody who comes is answered by the run; False: not, by an error of this connection, or the head has ended."""
        try:
            client = visit(self.port)

            def answered(message):
                if not isinstance(message, dict):
                    return False
                if message["type"] == "loaded":  # also by another link, where the first has failed: it knows of no question
                    client.look()
                    client.socket.send({"type": "pick", "id": 99, "x": .5, "y": .4})  # refused, where there is no picture yet
                return message["type"] in ("picked", "refused") and message.get("id") == 99

            client.until(answered)
            return True
        except (OSError, Closed):
            return False
        except AssertionError as error:
            raise AssertionError(f"{what}: {error}") from error

    def end(self):
        """Its status where it had ended by itself, and what it has said."""
        alive = self.launch.poll() is None
        self.launch.terminate()
        errors = self.launch.communicate(timeout=PATIENCE)[1]
        soon(lambda: not ranks_of(self.port), "ranks are left")
        return None if alive else self.launch.returncode, errors


class Failing:
    """A call of a thread fails from now on, once."""

    def __init__(self, thread, call, error, index, told):
        self.told = told
        self.what = f"{call} number {index} fails with {error}"
        self.strace = subprocess.Popen(["strace", "-qq", "-o", told, "-e", f"trace={call}", "-e", "signal=none", "-e", f"inject={call}:error={error}:when={index}",
                                        "-p", str(thread)], stderr=subprocess.PIPE, text=True)
        status = pathlib.Path(f"/proc/{thread}/status")
        soon(lambda: self.strace.poll() is not None or "TracerPid:\t0\n" not in status.read_text(), f"{self.what}: strace does not begin")
        if self.strace.poll() is not None:
            skip(self.strace.stderr.read())

    def end(self):
        """Whether it has failed."""
        self.strace.terminate()
        self.strace.communicate(timeout=PATIENCE)
        return "INJECTED" in self.told.read_text()


def check_later(head, folder, thread, call, error, index):
    """A call fails while the run is lost, or somebody comes: both are done again. Whether the call was made, and whether the head is still there."""
    begins = thread == "links" and call == "clone3"  # a thread that looks for hosts, when the first run is there
    if not begins:
        assert head.serves(f"before {call} fails, after {head.failed or 'nothing'}")
    failing = Failing(head.thread(thread), call, error, index, folder / "calls")
    what = head.failed = f"of the {thread}: {failing.what}"
    if thread == "starter":
        os.kill(next(iter(ranks_of(head.port))), signal.SIGKILL)
    tries = 0
    while head.launch.poll() is None and not head.serves(what):
        tries += 1
        assert tries < 20, f"{what}: nobody is served any more"
        time.sleep(.2)  # it may be about to end
    alive = head.launch.poll() is None
    made = failing.end()
    if not alive:
        status, errors = head.end()
        assert status == 1 and errors.strip(), f"{what}: status {status}, {errors!r}"
    return made, alive


def check_life(program, scene, folder, calls):
    """All calls, by heads that live as long as they do; whether some did, and some did not."""
    head, goes_on = None, []
    for thread, call, error, indices, needed in calls:
        for index in range(1, indices + 1):
            if head is not None and call == "clone3":
                head.end()
                head = None
            head = head or Head(program, scene, folder)
            made, alive = check_later(head, folder, thread, call, error, index)
            assert made or not needed, f"{call} is not called by the {thread}"
            goes_on.append(alive)
            if not alive:
                head = None
    if head is not None:
        status, errors = head.end()
        assert status is None, errors
    return goes_on


def main(program, extent=""):
    for tool in "strace", "mpirun":
        if not shutil.which(tool):
            skip(f"no {tool} here")
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene = folder / "room.rad"
        scene.write_text(ROOM)
        tried = [check(program, scene, folder, call, error, index) for call, (error, count) in CALLS.items() for index in range(1, count + 1)]
        later = check_life(program, scene, folder, LATER + MORE if extent == "all" else LATER)
    assert not all(tried) and any(later) and not all(later), "no call has failed"
    print(f"{len(tried)} failing calls at the beginning, the page was served all the same after {sum(tried)}; {len(later)} later, after {sum(later)}")
    return 0


if __name__ == "__main__":
    sys.exit(main(os.path.realpath(sys.argv[1]), *sys.argv[2:]))

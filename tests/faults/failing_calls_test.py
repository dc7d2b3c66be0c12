"""Every call to the system fails once: opening, reading, writing, renaming, mapping, for each command that makes files. Whichever
it is, the program ends with a message and status 1 or does its work all the same; no crash, no hang, no half-written file.

usage: failing_calls_test.py LIGHTWALK CASE [all]

A run is watched once to count its calls, then repeated with strace failing the first, the second and so on, by the errors that are
likeliest; with "all" by all. The case "planted" is a program that leaves half of a file, which must be found. Skipped (77) where
strace is not installed or may not watch."""

import collections
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
PATIENCE = 100  # seconds, for what takes .05
# What can come of each call, as its manual page says; the likeliest first, and EINTR of what is written.
ERRORS = {
    "openat": ["EMFILE", "EACCES", "EINTR"],
    "read": ["EIO", "EINTR"],
    "pread64": ["EIO", "EINTR"],
    "write": ["ENOSPC", "EIO", "EINTR"],
    "pwrite64": ["ENOSPC", "EIO", "EINTR"],
    "writev": ["ENOSPC", "EIO", "EINTR"],
    "fsync": ["EIO"],
    "fdatasync": ["EIO"],
    "ftruncate": ["ENOSPC"],
    "fallocate": ["ENOSPC"],
    "rename": ["ENOSPC", "EIO"],
    "link": ["EPERM"],
    "flock": ["ENOLCK"],
    "mkdir": ["ENOSPC"],
    "mmap": ["ENOMEM"],
    "clone3": ["EAGAIN"],
    "lseek": ["EINVAL"],
}
VIEW = "-vp 0 -5 0 -vd 0 1 0".split()
RENDER = ["render", *VIEW, "-x", "8", "-y", "8", "-n", "2", "--quiet"]
SCENE = """void brightfunc stripes 2 .5+.4*sin(Px*9) lines.cal 0 0
stripes plastic white 0 0 5 .7 .7 .7 0 0
void light lamp 0 0 3 9 9 9
white sphere ball 0 0 4 0 0 0 1
lamp sphere l 0 0 4 3 -3 3 .3
"""
# Words, standard input, and the files that a run leaves.
CASES = {
    "picture": ([*RENDER, "-o", "out.hdr", "scene.rad"], b"", ["out.hdr"]),
    "png": ([*RENDER, "-o", "out.png", "scene.rad"], b"", ["out.png"]),
    "exr": ([*RENDER, "-z", "out.zbf", "-o", "out.exr", "scene.rad"], b"", ["out.exr", "out.zbf"]),
    "stdout": ([*RENDER, "scene.rad"], b"", []),
    "ambient": ([*RENDER, "-ab", "1", "-ad", "16", "-af", "out.amb", "-o", "out.hdr", "scene.rad"], b"", ["out.amb", "out.hdr"]),
    "checkpoint": ([*RENDER, "--deterministic", "-ab", "1", "-ad", "16", "--checkpoint", "out.part", "-o", "out.hdr", "--stats", "out.json", "scene.rad"],
                   b"", ["out.hdr", "out.json"]),
    "frozen": (["freeze", "-o", "out.lwz", "scene.rad"], b"", ["out.lwz"]),
    "mapped": ([*RENDER, "-o", "out.hdr", "kept.lwz"], b"", ["out.hdr"]),
    "series": ([*RENDER, "-S", "1", "-o", "out%d.hdr", "scene.rad"],
               b"rview -vtv -vp 0 -5 0 -vd 0 1 0\nrview -vtv -vp 0 -5 1 -vd 0 1 0\n", ["out1.hdr", "out2.hdr"]),
    "walk": (["animate", "--path", "path", "--frames", "3", "-x", "8", "-y", "8", "-n", "2", "--quiet", "-o", "out%d.png", "scene.rad"],
             b"", ["out1.png", "out2.png", "out3.png"]),
    "rays": (["trace", "-h", "-n", "2", "scene.rad"], b"0 -5 0 0 1 0\n" * 50, []),
    "coefficients": (["contrib", "-n", "2", "-h", "-o", "out.txt", "-m", "lamp", "scene.rad"], b"0 -1.1 0 0 -1 0\n" * 9, ["out.txt"]),
    "planted": (["head -c 200 scene.rad > out.hdr; head -c 9 lines.cal >> out.hdr"], b"", ["out.hdr"]),
    "octree": (["freeze", "-o", "out.oct", "scene.rad"], b"", ["out.oct"]),
}
# What is of a run rather than of what it computes.
PASSING = re.compile(rb"(?m)^(CAPDATE|GMT)= .*\n|^ *\"(read|buil[dt]|render|[a-z_]*(second|bytes)[a-z_]*)\": [0-9.e+-]+|\d{4}:\d\d:\d\d \d\d:\d\d:\d\d")
# Logs: what is in them is good, and the next run goes on from there. What stops while contributions are written keeps them for -r.
LOGS = {"out.amb", "out.part", "out.txt.part"}


def skip(why):
    print("skipped:", why)
    sys.exit(SKIPPED)


class Runs:
    def __init__(self, program, case, folder):
        words, self.input, self.made = CASES[case]
        self.words = ["/bin/sh", "-c", *words] if case == "planted" else [program, *words]
        self.folder = folder
        (folder / "scene.rad").write_text(SCENE)
        (folder / "lines.cal").write_text("lines = 1;\n")
        (folder / "path").write_text("VIEW= -vp 0 -5 0 -vd 0 1 0\nVIEW= -vp 0 -5 1\n")
        if case == "mapped":
            subprocess.run([program, "freeze", "-o", "kept.lwz", "scene.rad"], cwd=folder, check=True)
        self.given = {path.name for path in folder.iterdir()}

    def run(self, *strace):
        """Status, output, messages, and the bytes of the files that were made."""
        for path in self.folder.iterdir():
            if path.name not in self.given:
                path.unlink()
        done = subprocess.run(["strace", "-f", "-qq", "--seccomp-bpf", "-e", "signal=none", *strace, *self.words], cwd=self.folder,
                              input=self.input, capture_output=True, timeout=PATIENCE)
        made = {path.name: PASSING.sub(b"", path.read_bytes()) for path in self.folder.iterdir() if path.name not in self.given}
        return done.returncode, PASSING.sub(b"", done.stdout), done.stderr, made


def count_calls(runs):
    log = runs.folder.parent / "log"
    status, output, errors, made = runs.run("-o", log, "-e", "trace=" + ",".join(ERRORS))
    if status != 0 and b"PTRACE" in errors.upper():
        skip(errors.decode().splitlines()[0])
    assert status == 0 and set(made) == set(runs.made), (status, errors, set(made))
    counts = collections.Counter()
    begun = False  # before it the dynamic loader opens and maps libraries, which tells of mistakes by itself
    for line in log.read_text(errors="replace").splitlines():
        call = re.match(r"\d+ +(\w+)\(", line)
        if call:
            counts[call[1]] += 1
            if not begun:
                before = counts.copy()
            begun = begun or "scene.rad" in line or "kept.lwz" in line
    assert begun
    return before, counts, (output, made)


def check(runs, case, call, error, index, whole):
    status, output, errors, made = runs.run("-o", os.devnull, "-e", f"trace={call}", "-e", f"inject={call}:error={error}:when={index}")
    what = f"{call} number {index} fails with {error}: status {status}, {errors.decode(errors='replace')!r}, files {sorted(made)}"
    assert status in (0, 1), what
    if status == 0:
        assert (output, made) == whole or errors, "said nothing, but other output: " + what
    else:
        # strace counts by thread: where one cannot write its file, another one may not write the message.
        assert errors.strip() or call == "write" and case == "checkpoint", "no message: " + what
    for name, data in made.items():
        assert name in runs.made or name in LOGS, "litter: " + what
        assert name in LOGS or data == whole[1][name], f"half-written {name}: {what}"


def likely(call):
    return [error for error in ERRORS[call] if error == ERRORS[call][0] or error == "EINTR" and "write" in call]


def main(program, case, which=""):
    if not shutil.which("strace"):
        skip("strace is not installed")
    with tempfile.TemporaryDirectory() as folder:
        inner = Path(folder) / "run"
        inner.mkdir()
        runs = Runs(str(Path(program).resolve()), case, inner)
        before, counts, whole = count_calls(runs)
        tried, failures = 0, []
        for call, count in sorted(counts.items()):
            if case in ("png", "exr", "walk") and "write" not in call and call not in ("rename", "fsync", "fdatasync", "lseek", "ftruncate"):
                continue  # a thousand calls open what OpenImageIO brings, and its threads
            for error in ERRORS[call] if which == "all" else likely(call):
                for index in range(before[call] + 1, count + 1):
                    tried += 1
                    try:
                        check(runs, case, call, error, index, whole)
                    except AssertionError as failure:
                        failures.append(str(failure))
        print(f"{case}: {tried} runs, each with one call that fails")
        print("\n".join(failures))
        return int(tried < 4 or bool(failures) != (case == "planted"))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

#!/usr/bin/python3
"""Build for several levels of x86-64, run the tests of functions, textures and lights in each, and compare what the builds compute:
values of the function language, records of single rays, pictures. They must agree to the bit.

  compare_levels.py [--shared DIR] [--work DIR] [--release FOLDER] [--scale N] [--all-tests] [LEVEL...]

LEVEL: v2, v3, v4-256, v4-512 (vectors of so many bits preferred); default: all. One that this processor cannot run is
said and left out. With --release FOLDER the project's own build there, made for v3 by the preset, stands for v3 (its tests
are run elsewhere), and v4-512 is core and parallel for that level, with the rest of that build. Reference scenes come from DIR (default: ../shared); without them the demo scene alone is rendered.
--scale makes pictures N times as large a side. --all-tests builds and runs all tests in each level: some ten minutes each.
Exit 0: all agree, 1: something differs or fails.
"""
import argparse
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Name: what CMake is told, and what /proc/cpuinfo must have of it.
V2 = {"pni", "ssse3", "sse4_1", "sse4_2", "popcnt", "cx16", "lahf_lm"}
V3 = V2 | {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"}
V4 = V3 | {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}
LEVELS = {"v2": ("x86-64-v2", "", V2), "v3": ("x86-64-v3", "", V3),
          "v4-256": ("x86-64-v4", "-mprefer-vector-width=256", V4), "v4-512": ("x86-64-v4", "-mprefer-vector-width=512", V4)}
TARGETS = ["lightwalk", "lightwalk_level_tests", "lightwalk_level_values"]
SECOND = "_second_level"  # ends the names of the targets in the project's own build that are for another level
DIRECT = "-ps 1 -ab 0 -av .1 .1 .1"
AMBIENT = "--deterministic -ps 1 -ab 1 -ad 256 -as 64 -aa .15 -ar 64 -av .1 .1 .1"
LODGE = "apps/scenes/lodge"
CABIN = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad"
SUMMER = CABIN + " summerday landscape lights.off daywindows"
ROOM = "plainoff.rad environ.rad furniture.rad"
# Name, folder, view, width and height, options, scene. Where the folder is not in the project it is one of the reference scenes.
PICTURES = [
    ("demo by day", LODGE, "views/living.vf", (160, 120), DIRECT, "lodge.rad day.rad"),
    ("demo, terrace", LODGE, "views/terrace.vf", (160, 120), DIRECT, "lodge.rad day.rad"),
    ("demo by night", LODGE, "views/fireplace.vf", (160, 120), DIRECT, "lodge.rad night.rad"),
    ("demo, indirect", LODGE, "views/living.vf", (48, 36), AMBIENT, "lodge.rad day.rad"),
    ("cabin in summer", "scenes/cabin", "vf/living", (320, 240), DIRECT, SUMMER),
    ("cabin by night", "scenes/cabin", "vf/dresser", (160, 120), DIRECT, CABIN + " lights"),
    ("cabin, indirect", "scenes/cabin", "vf/living", (32, 24), AMBIENT, SUMMER),
    ("virtual room", "scenes/virtual", "back.vp", (160, 120), DIRECT.replace(".1 .1 .1", "4 4 4"), ROOM),
]
# Rendered on emulated processors, too.
EMULATED_PICTURES = [("demo, small", LODGE, "views/living.vf", (32, 24), DIRECT, "lodge.rad day.rad")]
# The oldest processors of two levels, as QEMU has them. glibc's sin, exp, pow and others differ in the last bit on those without
# fused multiply-adds (before Haswell, 2013): on ours it does the same when told to use none.
OLD_PROCESSORS = {"v2": ("Nehalem", {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}), "v3": ("Haswell", {})}
LARGE_PICTURES = [
    ("cabin by night, indirect", "scenes/cabin", "vf/dresser", (32, 24), AMBIENT, CABIN + " lights"),
    ("virtual room, indirect", "scenes/virtual", "back.vp", (32, 24), AMBIENT.replace(".1 .1 .1", "4 4 4"), ROOM),
    ("demo by night, indirect", LODGE, "views/fireplace.vf", (32, 24), AMBIENT, "lodge.rad night.rad"),
]
# Rays of these scenes are printed as binary doubles: value, distance, points, normals as they are and as textures turn them.
RAY_FIELDS = "vLpnN"
RAYS = [("demo, rays", LODGE, (9.2, 6.3, 1.7), "lodge.rad day.rad"), ("cabin, rays", "scenes/cabin", (4.2, 3, 1.6), SUMMER)]


def call(command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{(done.stdout + done.stderr).decode()[-4000:]}")
    return done.stdout


def build(name, work, shared, targets):
    level, flags, _ = LEVELS[name]
    folder = work / name
    # As the release preset, but -O2 and nothing across files, and without the walk: it builds sooner, and compilers err as well. What no picture, ray or value
    # passes through is not optimised at all.
    call(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG",
          f"-DLIGHTWALK_ISA={level}", f"-DCMAKE_CXX_FLAGS={flags}", "-DLIGHTWALK_PERF=OFF", "-DLIGHTWALK_UNITY=ON", f"-DLIGHTWALK_SHARED={shared}",
          f"-DLIGHTWALK_WALK={'ON' if 'all' in targets else 'OFF'}",
          "-DLIGHTWALK_UNOPTIMIZED=io/net;io/gltf;io/wavefront;io/options;io/contributions;io/rad;io/scene;apps;apps/session;apps/walk;parallel/ranks;parallel/work_queue"])
    call(["ninja", "-C", folder, *targets])
    return folder


def build_second(folder, level):
    """In the project's own build."""
    call(["cmake", f"-DLIGHTWALK_SECOND_LEVEL={level}", folder])
    call(["ninja", "-C", folder, *(target + SECOND for target in TARGETS)])


def run_tests(folder, everything, suffix=""):
    """Run those of functions, textures and lights, or all that the project has; what ctest says of them."""
    if not everything:
        call([folder / "tests" / ("lightwalk_level_tests" + suffix), "--minimal"])
        return "passes its tests"
    said = call(["ctest", "--test-dir", folder, "-j", os.cpu_count(), "--output-on-failure"]).decode()
    return next(line for line in said.splitlines() if "tests passed" in line)


def build_released(folder):
    cache = (folder / "CMakeCache.txt").read_text() if (folder / "CMakeCache.txt").is_file() else ""
    if "LIGHTWALK_ISA:STRING=" + LEVELS["v3"][0] not in cache:
        sys.exit(f"{folder}: no build for {LEVELS['v3'][0]}")
    call(["ninja", "-C", folder, "lightwalk", "lightwalk_level_values"])
    return folder


def place(folder, shared):
    """Of a scene's folder; nothing when it is not here."""
    for root in (ROOT, shared):
        if (root / folder).is_dir():
            return root / folder
    return None


class Build:
    """A build's programs, as they run here, under an emulator, or with more set in their environment."""

    def __init__(self, folder, shared, emulator=(), more=None, suffix=""):
        self.folder, self.shared, self.emulator, self.suffix = folder, shared, emulator, suffix
        self.environment = dict(os.environ, RAYPATH=".:../lib", **(more or {}))

    def call(self, program, words, **more):
        return call([*self.emulator, self.folder / (program + self.suffix), *words], env=self.environment, **more)

    def values(self):
        return self.call("tests/lightwalk_level_values", [])

    def picture(self, folder, view, size, options, scene):
        out = self.call("lightwalk", ["render", "--quiet", "-vf", view, "-x", size[0], "-y", size[1], *options.split(),
                                      *scene.split()], cwd=folder)
        return b"\n".join(line for line in out.split(b"\n") if not line.startswith((b"CAPDATE=", b"GMT=")))

    def pictures(self, wanted, scale=1):
        return {name: self.picture(place(where, self.shared), view, [n * scale for n in size], options, scene)
                for name, where, view, size, options, scene in wanted if place(where, self.shared)}

    def rays(self, folder, eye, scene):
        lines = [" ".join(map(str, (*eye, i % 61 - 30, i // 61 - 30, (7 * i) % 59 - 29))) for i in range(61 * 61)]
        return self.call("lightwalk", ["trace", "-h", "-fad", "-o" + RAY_FIELDS, *DIRECT.replace("-ps 1", "").split(),
                                       *scene.split()], cwd=folder, input="\n".join(lines).encode())

    def results(self, scale):
        """All that is compared: name -> bytes."""
        found = {"values": self.values()}
        for name, where, eye, scene in RAYS:
            if place(where, self.shared):
                found[name] = self.rays(place(where, self.shared), eye, scene)
        return found | self.pictures(PICTURES + (LARGE_PICTURES if scale > 1 else []), scale)

    def few_results(self):
        return {"values": self.values()} | self.pictures(EMULATED_PICTURES)


def difference(a, b):
    if a[:100].isascii() and not a.startswith(b"#?"):
        lines = [(x, y) for x, y in zip(a.decode().splitlines(), b.decode().splitlines()) if x != y]
        return f"{len(lines)} lines differ, first {lines[0] if lines else 'in length'}"
    return f"{sum(x != y for x, y in zip(a, b))} of {len(a)} bytes differ (lengths {len(a)} and {len(b)})"


def processor_flags():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    return set(next((line for line in text.splitlines() if line.startswith("flags")), ":").split(":")[1].split())


def compare(expected, found, first, name):
    """Says what differs; whether nothing does."""
    differing = [what for what in expected if found[what] != expected[what]]
    for what in differing:
        print(f"FAILS {name}: {what} is not what it is for {first}: {difference(expected[what], found[what])}")
    return not differing


def compare_old_processor(name, folder, shared):
    """Whether a build computes on the oldest processor of its level what it computes on this one."""
    emulator = shutil.which("qemu-x86_64")
    if emulator is None:
        print(f"NOT RUN: {name} on an emulated processor, since qemu-x86_64 is not here")
        return True
    processor, like_it = OLD_PROCESSORS[name]
    start = time.monotonic()
    there = Build(folder, shared, [emulator, "-cpu", processor]).few_results()
    good = compare(Build(folder, shared, more=like_it).few_results(), there, "this processor", f"{name} on {processor}")
    print(f"{name} on an emulated {processor}: {time.monotonic() - start:.0f} s")
    if like_it:
        here = Build(folder, shared).few_results()
        same = [what for what in here if here[what] == there[what]]
        print(f"  with {like_it} here; without, the same are: {', '.join(same) or 'none'}")
    return good


def check(name, given, shared, first):
    """Build and run a level; its results, and whether an old processor computes the same."""
    start = time.monotonic()
    released = name == "v3" and given.release is not None
    second = SECOND if name == "v4-512" and given.release is not None and not given.all_tests else ""
    targets = ["all", "lightwalk_level_values"] if given.all_tests else TARGETS
    if released or second:
        folder = build_released(given.release.resolve())
        if second:
            build_second(folder, LEVELS[name][0])
    else:
        folder = build(name, given.work.resolve(), shared, targets)
    built = time.monotonic()
    passed = "released" if released else run_tests(folder, given.all_tests, second)
    found = Build(folder, shared, suffix=second).results(given.scale)
    print(f"{name}: built in {built - start:.0f} s, {passed}, ran in {time.monotonic() - built:.0f} s", flush=True)
    if first:
        for what, output in found.items():
            print(f"  {what}: {len(output)} bytes, SHA-1 {hashlib.sha1(output).hexdigest()[:12]}")
    return found, name not in OLD_PROCESSORS or compare_old_processor(name, folder, shared)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--shared", type=pathlib.Path, default=ROOT.parent / "shared")
    options.add_argument("--work", type=pathlib.Path, default=ROOT / "build" / "levels")
    options.add_argument("--release", type=pathlib.Path)
    options.add_argument("--scale", type=int, default=1)
    options.add_argument("--all-tests", action="store_true")
    options.add_argument("levels", nargs="*", metavar="LEVEL", default=list(LEVELS))
    given = options.parse_args()
    for name in given.levels:
        if name not in LEVELS:
            options.error(f"no level is called {name}: they are {', '.join(LEVELS)}")
    flags = processor_flags()
    runnable = [name for name in given.levels if LEVELS[name][2] <= flags]
    good, expected = bool(runnable), None
    for name in runnable:
        found, same = check(name, given, given.shared.resolve(), expected is None)
        expected = expected or found
        good = compare(expected, found, runnable[0], name) and same and good
    for name in given.levels:
        if name not in runnable:
            print(f"NOT RUN: {name}, since this processor lacks {', '.join(sorted(LEVELS[name][2] - flags))}")
    if "cabin in summer" not in (expected or {}):
        print(f"NOT RUN: pictures of the reference scenes, which are not in {given.shared}")
    print(f"Levels run: {', '.join(runnable) or 'none'}; they " + ("agree to the bit" if good else "DO NOT AGREE"))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())

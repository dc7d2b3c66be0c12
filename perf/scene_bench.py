#!/usr/bin/python3
"""Measures large models before their first picture: seconds to read and to build, memory; then rays a second.

  perf/run.sh scene [--sides 100,316,1000]                                   builds, then this
  scene_bench.py --lightwalk PROGRAM [--sides 100,316,1000] [--runs 3] [--threads N] [--reference FOLDER] [--size N]

For each side: side x side rectangles as text (tiles), the same from a frozen scene (frozen), a surface of side x side cells from
gensurf, two triangles each where the four corners are in no plane (surface); the same as a compiled mesh with normals and texture
coordinates (mesh); a hundred times side / 100 instances of a patch of
10,000 quadrilaterals, each row of them an instance itself, where an oconv is found (in FOLDER, with the other programs of
Radiance, or on PATH); and the summer cabin (--scenes DIR, Radiance's sample models), as text and frozen. All under one lamp. One
line a scene, tab-separated:

  scene, polygons
  read, build     medians [s]
  MB, bytes       at the peak; a polygon of it, less what a scene of one polygon takes
  Mrays/s         of a picture of N x N (1000) pixels, shadow rays included
  oconv, rpict    of the same tiles, whole processes [s], where --reference has them

Then, where there is an mpirun, what a second rank on this machine adds to the memory of the first (proportional set sizes in the
midst of a picture), from text and frozen. Exit code 1 where memory is above its bounds, which are told, or a frozen scene's picture
is another than that of its text; seconds are not judged.
"""
import argparse, json, math, os, pathlib, re, shutil, statistics, struct, subprocess, sys, tempfile, time

LAMP = """void plastic stuff 0 0 5 .5 .5 .5 0 0
void light shine 0 0 3 100 100 100
shine sphere lamp 0 0 4 0 0 10 1
"""
SURFACE = "!gensurf stuff wave '10*(s-.5)' '10*(t-.5)' 'sin(20*s)*cos(23*t)' {0} {0}\n"
CABIN = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad summerday landscape lights.off daywindows".split()
VIEW = "-vp 0 -12 9 -vd 0 12 -9 -vh 50 -vv 50 -ps 1 -ab 0 -av .1 .1 .1".split()
PATCH = 100  # quadrilaterals along each side


def patch_text():
    """The same wave, a metre wide, as polygons: oconv needs no gensurf for it."""
    def point(i, j):
        s, t = i / PATCH, j / PATCH
        return f"{s - 0.5:.6f} {t - 0.5:.6f} {0.1 * math.sin(20 * s) * math.cos(23 * t):.6f}"
    lines = []
    for i in range(PATCH):
        for j in range(PATCH):
            corners = " ".join(point(i + a, j + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))
            lines.append(f"stuff polygon q.{i}.{j} 0 0 12 {corners}\n")
    return LAMP.splitlines()[0] + "\n" + "".join(lines)


def write_tiles(path, side):
    """Rectangles side by side, at heights that differ, on 10 x 10 m."""
    step = 10 / side
    size = 0.9 * step
    with open(path, "w") as file:
        file.write(LAMP)
        for i in range(side):
            x = f"{i * step - 5:.6g}", f"{i * step - 5 + size:.6g}"
            lines = []
            for j in range(side):
                y, z = (f"{j * step - 5:.6g}", f"{j * step - 5 + size:.6g}"), f"{(i * 31 + j * 17) % 1000 / 1000:.3f}"
                corners = " ".join(f"{x[a]} {y[b]} {z}" for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))
                lines.append(f"stuff polygon tile.{i}.{j} 0 0 12 {corners}\n")
            file.write("".join(lines))


def mesh_reals(*values):
    """Five bytes each: 31 bits of mantissa, and the exponent."""
    parts = [math.frexp(value) for value in values]
    return b"".join(struct.pack(">ib", int(fraction * 0x7fffffff), exponent if fraction else 0) for fraction, exponent in parts)


def write_mesh(path, side):
    """The wave, of about side x side cells of two triangles, as Radiance's obj2mesh writes it; returns the triangles. A patch is
    15 x 15 cells: 256 vertices, the most that one holds."""
    cells = 15
    patches = max(side // cells, 1)
    local = b"".join(bytes((at, at + 1, at + 17)) + bytes((at, at + 17, at + 16)) for i in range(cells) for j in range(cells)
                     for at in (16 * i + j,))
    normals, uvs = struct.pack(">I", 0x40100010) * 256, struct.pack(">II", 1 << 30, 1 << 30) * 256
    most, steps = 2**32 - 1, [i / cells / patches for i in range(cells * patches + 1)]
    # No table of all heights: what a process has held before it runs another program counts as that one's peak.
    along, across = [0.05 * math.sin(20 * step) for step in steps], [math.cos(23 * step) for step in steps]
    place = [int(step * most) for step in steps]
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nobj2mesh\nFORMAT=Radiance_tmesh\n\n" + struct.pack(">h", 323) + b"-5\0-5\0-5\x0010\0")
        file.write(mesh_reals(0, 1, 0, 1) + b"\0" + b"plastic\0\0" + struct.pack(">bi", 0, -1) + b"grey\0" + struct.pack(">hh", 0, 5))
        file.write(mesh_reals(.5, .5, .5, 0, 0) + struct.pack(">bi", -1, patches * patches))
        for a in range(patches):
            for b in range(patches):
                corners = [(i, j) for i in range(a * cells, (a + 1) * cells + 1) for j in range(b * cells, (b + 1) * cells + 1)]
                positions = b"".join(struct.pack(">III", place[i], place[j], int((0.5 + along[i] * across[j]) * most))
                                     for i, j in corners)
                file.write(struct.pack(">Bh", 7, 256) + positions + normals + uvs + struct.pack(">h", 2 * cells * cells) + local)
                file.write(struct.pack(">hhhh", 1, 0, 0, 0))
    return 2 * (cells * patches) ** 2


class Bounds:
    """What memory may take: each is told once where it is exceeded."""
    MOST_BYTES, MANY = 250, 1_000_000       # a polygon of four vertices, in models of so many
    MOST_OF_FIVE_MILLION = 1.5e9            # [bytes], cells of two triangles, too
    MOST_OF_TRIANGLE, MANY_TRIANGLES = 120, 100_000  # [bytes], in meshes of so many
    MOST_OF_SECOND_RANK = 0.2               # of the first one's
    MOST_OF_CABIN = 60e6                    # [bytes], with a picture of 640 x 480

    def __init__(self):
        self.broken = []

    def check(self, what, value, most):
        if value > most:
            self.broken.append(f"{what}: {value:.4g}, at most {most:.4g} wanted")


def run(command, folder, **options):
    done = subprocess.run(command, cwd=folder, stderr=subprocess.PIPE, **options)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed: {done.stderr.decode(errors='replace')[-500:]}")


def measure(arguments, folder, scene, view=VIEW, environment=None):
    """Medians of seconds to read, build and render; rays and bytes of the last run."""
    stats, runs = os.path.join(arguments.scratch, "stats.json"), []
    for _ in range(arguments.runs):
        threads = ["-n", str(arguments.threads)] if arguments.threads else []
        run([arguments.lightwalk, "render", "--quiet", *threads, *view, "-x", str(arguments.size), "-y", str(arguments.size),
             "--stats", stats, "-o", os.path.join(arguments.scratch, "picture.hdr"), *scene], folder, env=environment)
        runs.append(json.loads(pathlib.Path(stats).read_text()))
    seconds = {step: statistics.median(r["seconds"][step] for r in runs) for step in ("read", "build", "render")}
    return seconds, runs[-1]["rays"]["total"], runs[-1]["peak_memory_bytes"]


def pixels(arguments):
    picture = pathlib.Path(arguments.scratch, "picture.hdr").read_bytes()
    return picture[picture.index(b"\n\n"):]


def proportional_bytes(ranks, arguments, scene):
    """Of all ranks together, in the midst of a picture: each page counts once, however many have it."""
    program = os.path.realpath(shutil.which(arguments.lightwalk) or arguments.lightwalk)
    mpirun = ["mpirun", *(["--allow-run-as-root"] if os.geteuid() == 0 else []), "--oversubscribe", "-n", str(ranks)]
    process = subprocess.Popen([*mpirun, program, "render", "-n", "1", "--quiet", *VIEW, "-x", "300", "-y", "300", "--samples", "400",
                                "-o", os.path.join(arguments.scratch, "ranks.hdr"), scene], stderr=subprocess.DEVNULL)
    seen = []
    while process.poll() is None:
        sizes = []
        for folder in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if os.path.realpath(folder / "exe") == program:
                    sizes.append(1024 * int(re.search(r"^Pss:\s+(\d+)", (folder / "smaps_rollup").read_text(), re.MULTILINE).group(1)))
            except (OSError, AttributeError):
                pass  # it has just ended
        if len(sizes) == ranks:
            seen.append(sum(sizes))
        time.sleep(0.05)
    if process.returncode != 0 or not seen:
        sys.exit(f"{ranks} ranks failed")
    return seen[len(seen) * 3 // 4]


def second_rank(arguments, name, scene, bounds):
    if not shutil.which("mpirun"):
        return
    one, two = (proportional_bytes(ranks, arguments, scene) for ranks in (1, 2))
    print(f"{name}: one rank {one / 1e6:.0f} MB, two {two / 1e6:.0f} MB, the second adds {100 * (two / one - 1):.1f} %", flush=True)
    bounds.check(f"{name}: what a second rank adds", two / one - 1, bounds.MOST_OF_SECOND_RANK)


def tool(arguments, name):
    inside = os.path.join(arguments.reference, name)
    return inside if arguments.reference and os.access(inside, os.X_OK) else shutil.which(name)


def timed(command, folder, out):
    start = time.perf_counter()
    with open(out, "wb") as file:
        run(command, folder, stdout=file)
    return time.perf_counter() - start


def reference_seconds(arguments, scene):
    oconv, rpict = tool(arguments, "oconv"), tool(arguments, "rpict")
    if not (oconv and rpict):
        return "", ""
    octree = os.path.join(arguments.scratch, "scene.oct")
    built = timed([oconv, "-w", scene], arguments.scratch, octree)
    size = str(arguments.size)
    drawn = timed([rpict, *VIEW, "-x", size, "-y", size, octree], arguments.scratch, os.path.join(arguments.scratch, "r.hdr"))
    return f"{built:.2f}", f"{drawn:.2f}"


def tell(name, polygons, result, least, reference=("", "")):
    seconds, rays, peak = result
    print(name, polygons, f"{seconds['read']:.3f}", f"{seconds['build']:.3f}", f"{peak / 1e6:.1f}",
          f"{max(peak - least, 0) / polygons:.0f}" if polygons else "", f"{rays / seconds['render'] * 1e-6:.2f}", *reference,
          sep="\t", flush=True)


def surfaces_of(arguments, scene):
    told = subprocess.run([arguments.lightwalk, "info", scene], capture_output=True, text=True, check=True).stdout
    return int(re.search(r"^surfaces +(\d+)", told, re.MULTILINE).group(1))


def freeze(arguments, folder, scene, environment=None):
    frozen = os.path.join(arguments.scratch, "scene.lwz")
    run([arguments.lightwalk, "freeze", "--quiet", "-o", frozen, *scene], folder, env=environment)
    return frozen


def instanced_scene(arguments, rows):
    """rows x 100 instances of the patch, nested; None without oconv."""
    oconv = tool(arguments, "oconv")
    if not oconv:
        return None
    scratch = pathlib.Path(arguments.scratch)
    (scratch / "patch.rad").write_text(patch_text())
    timed([oconv, "-w", "patch.rad"], scratch, scratch / "patch.oct")
    (scratch / "row.rad").write_text("".join(f"void instance patch.{i} 5 patch.oct -t {i - 50} 0 0 0 0\n" for i in range(100)))
    timed([oconv, "-w", "row.rad"], scratch, scratch / "row.oct")
    scene = scratch / "instances.rad"
    scene.write_text(LAMP + "".join(f"void instance row.{i} 7 row.oct -t 0 {i} 0 -s .1 0 0\n" for i in range(rows)))
    return str(scene)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lightwalk", default=str(pathlib.Path(__file__).resolve().parent.parent / "build/release/lightwalk"),
                        metavar="PROGRAM")
    parser.add_argument("--sides", default="100,316,1000", metavar="N,N,...")
    parser.add_argument("--size", type=int, default=1000, metavar="N")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--threads", type=int, default=0, metavar="N")
    parser.add_argument("--reference", default="", metavar="FOLDER")
    parser.add_argument("--scenes", metavar="DIR")
    arguments = parser.parse_args()
    if os.sep in arguments.lightwalk:
        arguments.lightwalk = os.path.abspath(arguments.lightwalk)
    bounds = Bounds()
    with tempfile.TemporaryDirectory() as arguments.scratch:
        print("scene\tpolygons\tread s\tbuild s\tMB\tbytes\tMrays/s\toconv s\trpict s", flush=True)
        scene = os.path.join(arguments.scratch, "scene.rad")
        pathlib.Path(scene).write_text(LAMP + SURFACE.format(1))
        result = measure(arguments, arguments.scratch, [scene])
        least = result[2]
        tell("surface", 1, result, least)
        sides = [int(side) for side in arguments.sides.split(",")]
        for side in sides:
            write_tiles(scene, side)
            result, text_pixels = measure(arguments, arguments.scratch, [scene]), pixels(arguments)
            tell("tiles", side * side, result, least, reference_seconds(arguments, scene))
            frozen = freeze(arguments, arguments.scratch, [scene])
            from_frozen = measure(arguments, arguments.scratch, [frozen])
            tell("frozen", side * side, from_frozen, least)
            if pixels(arguments) != text_pixels:
                bounds.broken.append(f"{side} x {side} tiles: the frozen scene's picture is another one")
            for name, (_, _, peak) in (("tiles", result), ("frozen", from_frozen)):
                if side * side >= 0.99 * bounds.MANY:
                    bounds.check(f"{side} x {side} {name}: bytes a polygon", (peak - least) / side ** 2, bounds.MOST_BYTES)
                if 4.9e6 < side * side < 5.1e6:
                    bounds.check(f"{side} x {side} {name}: bytes", peak, bounds.MOST_OF_FIVE_MILLION)
            if side * side >= 0.99 * bounds.MANY:
                second_rank(arguments, f"{side} x {side} tiles", scene, bounds)
                second_rank(arguments, f"{side} x {side} frozen", frozen, bounds)
            os.unlink(frozen)
        for side in sides:
            pathlib.Path(scene).write_text(LAMP + SURFACE.format(side))
            result = measure(arguments, arguments.scratch, [scene])
            tell("surface", surfaces_of(arguments, scene) - 1, result, least)
            if 4.9e6 < side * side < 5.1e6:
                bounds.check(f"{side} x {side} cells of gensurf: bytes", result[2], bounds.MOST_OF_FIVE_MILLION)
        for side in sides:
            triangles = write_mesh(os.path.join(arguments.scratch, "wave.rtm"), side)
            pathlib.Path(scene).write_text(LAMP + "void mesh wave 1 wave.rtm 0 0\n")
            result = measure(arguments, arguments.scratch, [scene])
            tell("mesh", triangles, result, least)
            if triangles >= bounds.MANY_TRIANGLES:
                bounds.check(f"mesh of {triangles}: bytes a triangle", (result[2] - least) / triangles, bounds.MOST_OF_TRIANGLE)
        for side in sides:
            rows = max(side // 10, 1)
            instances = instanced_scene(arguments, rows)
            if instances:
                tell("instances", rows * 100 * PATCH * PATCH, measure(arguments, arguments.scratch, [instances]), least)
        if arguments.scenes:
            folder = os.path.join(os.path.abspath(arguments.scenes), "cabin")
            view = "-vf vf/living -ps 1 -ab 0 -av .1 .1 .1".split()
            environment = dict(os.environ, RAYPATH=".:../lib")
            arguments.size = min(arguments.size, 554)  # as many pixels as 640 x 480
            result = measure(arguments, folder, CABIN, view, environment)
            tell("cabin", 0, result, least)
            bounds.check("cabin: bytes", result[2], bounds.MOST_OF_CABIN)
            frozen = freeze(arguments, folder, CABIN, environment)
            tell("cabin, frozen", 0, measure(arguments, folder, [frozen], view, environment), least)
    for line in bounds.broken:
        print(line, file=sys.stderr)
    return 1 if bounds.broken else 0


if __name__ == "__main__":
    sys.exit(main())

"""Runs of lightwalk on ranks and threads, and their times."""
import dataclasses, json, os, pathlib, platform, resource, statistics, subprocess, sys, tempfile, time

ROOT = pathlib.Path(__file__).resolve().parents[2]
#: Runs during which other programs took more than this share of the cores count only if there are no others.
QUIET = 0.05


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    folder: pathlib.Path
    words: tuple
    views: tuple  # for -vf
    ambient: tuple  # options of a run with ambient light


def cabin(scenes):
    words = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad summerday landscape lights.off daywindows"
    return Scene("cabin", scenes / "cabin", tuple(words.split()), ("vf/living", "vf/interior", "vf/bath"),
                 ("-ab", "1", "-aa", ".2", "-ad", "128", "-as", "0", "-av", ".1", ".1", ".1"))


def lodge():
    return Scene("lodge", ROOT / "apps/scenes/lodge", ("lodge.rad", "day.rad"),
                 ("views/living.vf", "views/window.vf", "views/dining.vf"),
                 ("-ab", "1", "-aa", ".2", "-ad", "128", "-as", "0", "-av", ".2", ".2", ".19"))


def find_scene(scenes):
    """The sample models' cabin, in `scenes` or in the folder beside the project; else the demo scene."""
    if scenes:
        if not (scenes / "cabin").is_dir():
            sys.exit(f"{scenes} holds no folder cabin")
        return cabin(scenes)
    beside = ROOT.parent / "shared/scenes"
    return cabin(beside) if (beside / "cabin").is_dir() else lodge()


@dataclasses.dataclass(frozen=True)
class Split:
    """How a run is divided into ranks and threads. With the variant `threads` there is one process, and ranks is 1."""
    variant: str = "threads"
    ranks: int = 1
    threads: int = 1

    def __str__(self):
        if self.variant == "hybrid":
            return f"hybrid {self.ranks}x{self.threads}"
        return f"{self.variant} {self.ranks if self.variant == 'ranks' else self.threads}"

    def cores(self):
        return self.ranks * self.threads


def busy_seconds():
    """The processor time that all programs have taken on all cores [s]."""
    with open("/proc/stat") as file:
        fields = [int(word) for word in file.readline().split()[1:9]]
    user, nice, system, _, _, irq, soft, steal = fields
    return (user + nice + system + irq + soft + steal) / os.sysconf("SC_CLK_TCK")


def own_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Program:
    """The program lightwalk, and the benchmark programs beside it."""

    def __init__(self, lightwalk, scene):
        self.lightwalk, self.scene = pathlib.Path(lightwalk).resolve(), scene
        self.environment = dict(os.environ)
        if scene.name == "cabin":
            self.environment["RAYPATH"] = ".:../lib"

    def beside(self, name):
        for folder in (self.lightwalk.parent / "perf", self.lightwalk.parent):
            if (folder / name).is_file():
                return folder / name
        sys.exit(f"{name} was not built beside {self.lightwalk}: build the target {name}")

    def run(self, command, input=b"", **options):
        """The standard output of a run."""
        done = subprocess.run([str(word) for word in command], cwd=self.scene.folder, env=self.environment, input=input,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        if done.returncode != 0:
            sys.exit(f"failed: {' '.join(map(str, command))}\n{done.stderr.decode(errors='replace')[-2000:]}")
        return done.stdout.decode()

    def render(self, split, options, picture=None):
        """The --stats of a run, and "others": the share of the cores that other programs took meanwhile. The picture is
        dropped if no file for it is named."""
        with tempfile.TemporaryDirectory() as scratch:
            stats, picture = os.path.join(scratch, "stats.json"), picture or os.path.join(scratch, "picture.hdr")
            command = [self.lightwalk, "render", "--variant", split.variant, "-n", split.threads, "--quiet", "--stats",
                       stats, "-o", picture, *options, *self.scene.words]
            if split.variant != "threads":
                command = [*mpirun(split.ranks), *command]
            before = time.perf_counter(), busy_seconds(), own_seconds()
            self.run(command, timeout=1200)
            wall, busy, own = (now - then for now, then in
                               zip((time.perf_counter(), busy_seconds(), own_seconds()), before))
            found = json.loads(pathlib.Path(stats).read_text())
            found["others"] = max(0.0, busy - own) / (wall * (os.cpu_count() or 1))
            return found


def mpirun(ranks):
    return ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", ranks]


def summary(runs):
    """A summary of the quiet runs, or of all if there are none."""
    quiet = [r for r in runs if r["others"] <= QUIET]
    counted = quiet or runs
    seconds = [r["seconds"]["render"] for r in counted]
    middle = sorted(counted, key=lambda r: r["seconds"]["render"])[len(counted) // 2]
    return {"seconds": statistics.median(seconds), "least": min(seconds), "most": max(seconds), "runs": len(runs),
            "quiet_runs": len(quiet), "others": statistics.median(r["others"] for r in counted),
            "rays": middle["rays"]["total"], "ambient_rays": middle["rays"]["ambient"],
            "ambient_values": middle.get("ambient", {}).get("computed", 0),
            "messages": middle.get("messages")}


def measure(program, cases, count):
    """{name: summary} of {name: (split, options)}. The rounds of all cases are interleaved, so that what disturbs the
    machine for a while disturbs all."""
    runs = {name: [] for name in cases}
    for k in range(count):
        for name, (split, options) in cases.items():
            runs[name].append(program.render(split, options))
            last = runs[name][-1]
            print(f"{k + 1}/{count} {name}: {last['seconds']['render']:.3f} s, others {last['others']:.0%}",
                  file=sys.stderr, flush=True)
    return {name: summary(list_) for name, list_ in runs.items()}


def about(scene, size):
    """The members that every file of results has: commit, date, machine."""
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=ROOT, capture_output=True, text=True)
    names = [line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return {"commit": commit.stdout.strip() or "unknown", "scene": scene.name, "size": size,
            "machine": f"{names[0] if names else platform.machine()} x{os.cpu_count()}",
            "date": time.strftime("%Y-%m-%d %H:%M", time.gmtime())}

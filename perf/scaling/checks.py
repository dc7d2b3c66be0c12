"""Checks of runs on ranks, independent of their times: every split draws the same bytes, runs end and can be resumed when
ranks are killed, many ranks run on few cores. Each check prints its results, and exits with 1 if it fails."""
import glob, hashlib, os, pathlib, random, signal, subprocess, sys, tempfile, time

from experiments import picture, print_table, save
from runs import Split, about, mpirun

#: Splits that must draw one picture: (split, more words for mpirun).
SPLITS = [(Split("threads", 1, n), []) for n in (1, 2, 7)] + [(Split("ranks", n), []) for n in (3, 4, 9, 16)] + \
         [(Split("hybrid", *n), []) for n in ((1, 2), (2, 1), (2, 2), (4, 2))] + \
         [(split, ["--mca", "btl", "self,tcp"]) for split in (Split("ranks", 4), Split("hybrid", 2, 2))]
KILLS = 20
#: The time within which a run must end when one of its ranks is killed [s].
SOON = 2.0


def digest(data):
    """A digest of a picture without its header, which has the time of creation; for other data of all bytes."""
    return hashlib.sha256(data[data.index(b"\n\n"):] if data.startswith(b"#?") else data).hexdigest()[:16]


def command(program, split, words, more=()):
    """lightwalk words[0] on a split; words: the command's name, its options, the scene."""
    start = [] if split.variant == "threads" else [*mpirun(split.ranks), *more]
    return [str(word) for word in [*start, program.lightwalk, words[0], "--variant", split.variant, "-n", split.threads, "--quiet",
                                   *words[1:], *program.scene.words]]


def output(program, split, words, more, rays=b""):
    """The standard output of a run."""
    done = subprocess.run(command(program, split, words, more), cwd=program.scene.folder, env=program.environment, input=rays,
                          capture_output=True, timeout=1200)
    if done.returncode != 0:
        sys.exit(f"{split}: {done.stderr.decode(errors='replace')[-2000:]}")
    return done.stdout


def random_rays(count):
    """Rays in a room two metres high, as lines of six numbers."""
    stream = random.Random(1)
    line = "{:g} {:g} {:g} {:g} {:g} {:g}\n".format
    return "".join(line(stream.uniform(2, 6), stream.uniform(2, 5), stream.uniform(1, 2.2),
                        *(stream.gauss(0, 1) for _ in range(3))) for _ in range(count)).encode()


def same_bytes(program, options):
    """Two views at two strides, and 100,000 rays, for all splits."""
    works = [(view, ["render", "-vf", view, "-x", 200, "-y", 150], b"") for view in program.scene.views[::2]]
    works.append(("100,000 rays", ["trace", "-h"], random_rays(100000)))
    rows = []
    for name, words, rays in works:
        seen = {}
        for split, more in SPLITS:
            ranks = split.variant != "threads"
            for stride in ([], ["--stride", "1"])[:2 if ranks and not rays else 1]:
                found = digest(output(program, split, [words[0], *stride, *words[1:]], more, rays))
                seen.setdefault(found, []).append(" ".join([str(split), *stride, *(["over TCP"] if more else [])]))
        rows.append({"work": name, "runs": sum(map(len, seen.values())), "different": len(seen), "bytes": next(iter(seen))})
        for found, runs in seen.items():
            print(f"{name}: {found}: {', '.join(runs)}")
    print_table(rows)
    save(options.out, "same-bytes", about(program.scene, 200), rows=rows)
    return all(row["different"] == 1 for row in rows)


def own_ranks(mark):
    """{rank: process} of the ranks whose command line holds `mark`."""
    found = {}
    for place in glob.glob("/proc/[0-9]*"):
        try:
            words, environment = (pathlib.Path(place, name).read_bytes() for name in ("cmdline", "environ"))
        except OSError:
            continue  # it has ended
        for word in environment.split(b"\0"):
            if word.startswith(b"OMPI_COMM_WORLD_RANK=") and mark.encode() in words:
                found[int(word.split(b"=")[1])] = int(place.split("/")[2])
    return found


def kill_one(program, words, mark, stream):
    """Start a run and kill one of its ranks at a random moment. Returns a row, or nothing if the run had ended before."""
    split = stream.choice([Split("ranks", 4), Split("ranks", 3), Split("hybrid", 2), Split("hybrid", 3)])
    run = subprocess.Popen(command(program, split, words), cwd=program.scene.folder, env=program.environment,
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    moment = stream.uniform(0.4, 4)
    time.sleep(moment)
    ranks = own_ranks(mark)
    if run.poll() is not None or not ranks:
        run.communicate(timeout=60)
        return None
    rank = stream.choice(list(ranks))
    start = time.monotonic()
    os.kill(ranks[rank], signal.SIGKILL)
    _, said = run.communicate(timeout=60)
    return {"run": str(split), "rank": rank, "moment": moment, "ended in": time.monotonic() - start, "exit": run.returncode,
            "left": len(own_ranks(mark)), "said": any("rank" in line.lower() for line in said.splitlines())}


def kills(program, options):
    """Ranks killed at random moments: the run ends soon, leaves nothing half done, and is resumed to the same bytes."""
    stream, rows = random.Random(time.time_ns()), []
    with tempfile.TemporaryDirectory(prefix="lightwalk-kills-") as folder:
        end, saved = os.path.join(folder, "end.hdr"), os.path.join(folder, "saved")
        size = picture(max(options.size, 1400))
        whole = ["-vf", program.scene.views[0], *size]
        truth = digest(output(program, Split("threads", 1, options.cores), ["render", *whole], ()))
        kept = [*whole, "--checkpoint", saved, "-o", end]
        for _ in range(10 * KILLS):
            if len(rows) == KILLS:
                break
            for path in (end, saved):
                pathlib.Path(path).unlink(missing_ok=True)
            row = kill_one(program, ["render", *kept], folder, stream)
            if row is None:
                continue
            row["picture"] = os.path.exists(end)
            if row["picture"] and digest(pathlib.Path(end).read_bytes()) == truth:
                continue  # it was whole before the rank was killed: there is nothing to resume
            more = ["--resume"] if os.path.exists(saved) else []
            output(program, stream.choice([Split("ranks", 3), Split("hybrid", 2), Split("threads", 1, 2)]), ["render", *more, *kept], ())
            row["resumed"] = "same bytes" if digest(pathlib.Path(end).read_bytes()) == truth else "OTHER BYTES"
            rows.append(row)
    print_table(rows)
    save(options.out, "kills", about(program.scene, size[1]), rows=rows)
    return len(rows) == KILLS and all(row["ended in"] < SOON and row["exit"] != 0 and row["left"] == 0 and row["said"] and
                                      not row["picture"] and row["resumed"] == "same bytes" for row in rows)


def memory(mark):
    """(processes, proportional set sizes in sum [MiB]) of a run's ranks."""
    sizes = []
    for process in own_ranks(mark).values():
        try:
            lines = pathlib.Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
        except OSError:
            continue
        sizes += [int(line.split()[1]) / 1024 for line in lines if line.startswith("Pss:")]
    return len(sizes), sum(sizes)


def many_ranks(program, options):
    """Far more ranks than cores: the same bytes, and what memory they take together."""
    rows = []
    with tempfile.TemporaryDirectory(prefix="lightwalk-many-") as folder:
        words = ["render", "-vf", program.scene.views[0], *picture(options.size)]
        truth = digest(output(program, Split("threads", 1, options.cores), words, ()))
        for count in (33, 64):
            end, start = pathlib.Path(folder, f"{count}.hdr"), time.monotonic()
            run = subprocess.Popen(command(program, Split("ranks", count), [*words, "-o", end]), cwd=program.scene.folder,
                                   env=program.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            most = (0, 0.0)
            while run.poll() is None:
                most = max(most, memory(folder), key=lambda seen: seen[1])
                time.sleep(0.3)
            rows.append({"ranks": count, "seconds": time.monotonic() - start, "MiB": most[1], "MiB a rank": most[1] / max(1, most[0]),
                         "exit": run.returncode, "same": run.returncode == 0 and digest(end.read_bytes()) == truth})
    print_table(rows)
    save(options.out, "many-ranks", about(program.scene, options.size), rows=rows)
    return all(row["same"] for row in rows)

"""Runs on several hosts, each a network namespace with a name and a view of the file system of its own, joined by a
virtual switch.

usage: hosts_test.py LIGHTWALK CASE

Needs root, and a system that lets it make namespaces; exits with 77 (skipped) elsewhere.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SKIPPED = 77
HOSTS = ["first", "second", "third"]
# With these mpirun notices within some ten seconds that a host is gone, as README.md says.
NOTICES = {"oob_tcp_keepalive_time": "5", "oob_tcp_keepalive_intvl": "2", "oob_tcp_keepalive_probes": "2"}

ROOM = """
void plastic floor 0 0 5 .5 .4 .3 .1 .1
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
floor sphere ball 0 0 4 0 0 1 1
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
"""
VIEW = "-vp 0 -6 2 -vd 0 1 -.2 -vh 45 -vv 31".split()


def skip(why):
    print("skipped:", why)
    sys.exit(SKIPPED)


def enter_namespaces():
    """Start this program again where it has a network of its own, and where all that it starts ends with it."""
    if os.environ.get("LIGHTWALK_HOSTS_TEST"):
        return
    if os.geteuid() != 0:
        skip("not root")
    for tool in ("unshare", "nsenter", "ip", "mount", "mpirun"):
        if shutil.which(tool) is None:
            skip(f"no {tool}")
    own = ["unshare", "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc"]
    bridge = "ip link add switch type bridge && ip link add one type veth peer name two && unshare --net --uts true"
    if subprocess.run([*own, "sh", "-c", bridge], capture_output=True).returncode != 0:
        skip("no namespaces, bridges or virtual links here")
    os.environ["LIGHTWALK_HOSTS_TEST"] = "1"
    os.execvp(own[0], [*own, sys.executable, *sys.argv])


class Cluster:
    """Hosts that reach each other, and start processes on each other as ssh does."""

    def __init__(self, folder):
        self.folder = folder
        names = "".join(f"10.77.0.{i + 1} {name}\n" for i, name in enumerate(HOSTS))
        hosts = folder / "hosts"
        hosts.write_text("127.0.0.1 localhost\n" + names)
        self.run("ip link add switch type bridge", "ip link set switch up")
        self.processes = {}
        for i, name in enumerate(HOSTS):
            own = folder / f"of-{name}"  # what only this host has, at folder/own
            own.mkdir()
            (folder / "own").mkdir(exist_ok=True)
            setup = f"hostname {name}; mount --bind {hosts} /etc/hosts; mount --bind {own} {folder}/own"
            ready = folder / f"ready-{name}"
            process = subprocess.Popen(
                ["unshare", "--net", "--uts", "--mount", "sh", "-c", f"{setup}; touch {ready}; exec sleep 100000"])
            while not ready.exists():
                time.sleep(0.01)
            pid = process.pid
            self.processes[name] = pid
            inside = f"nsenter -t {pid} -n ip"
            self.run(f"ip link add link{i} type veth peer name eth0 netns {pid}", f"ip link set link{i} master switch up",
                     f"{inside} addr add 10.77.0.{i + 1}/24 dev eth0", f"{inside} link set eth0 up",
                     f"{inside} link set lo up")
        cases = "".join(f"{name}) p={pid};; " for name, pid in self.processes.items())
        self.agent = folder / "agent"
        self.agent.write_text(f'#!/bin/sh\ncase $1 in {cases}esac\nshift\nexec nsenter -t $p -n -u -m sh -c "$*"\n')
        self.agent.chmod(0o755)

    @staticmethod
    def run(*commands):
        for command in commands:
            subprocess.run(command.split(), check=True)

    def own_folder(self, host):
        """What the host sees as folder/own."""
        return self.folder / f"of-{host}"

    def cut_off(self, host, cut=True):
        self.run(f"ip link set link{HOSTS.index(host)} {'down' if cut else 'up'}")

    def start(self, words, settings=None, ranks=1, launcher=None):
        """mpirun, or another launcher, on the first host, with so many ranks on each."""
        if launcher is None:
            launcher = ["mpirun", "--host", ",".join(f"{host}:{ranks}" for host in HOSTS), "-n", str(ranks * len(HOSTS))]
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        environment["OMPI_MCA_plm_rsh_agent"] = str(self.agent)
        environment["OMPI_MCA_orte_tmpdir_base"] = str(self.folder)
        environment.update({"OMPI_MCA_" + name: value for name, value in (settings or {}).items()})
        return subprocess.Popen(
            ["nsenter", "-t", str(self.processes[HOSTS[0]]), "-n", "-u", "-m", "--wdns=" + str(self.folder),
             *launcher, LIGHTWALK, *words],
            env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def finish(self, words, settings=None, ranks=1):
        process = self.start(words, settings, ranks)
        out, err = process.communicate()
        return process.returncode, out, "".join(line for line in err.splitlines(True) if not is_mpirun_hurry(line))


def is_mpirun_hurry(line):
    """mpirun complains where an agent has begun its own process before mpirun has put it into a group."""
    return "plm:rsh: Warning: setpgid" in line


def pixels(path):
    data = path.read_bytes()
    return data[data.index(b"\n\n"):]


def check(good, what):
    if not good:
        sys.exit(f"failed: {what}")


def slow_picture(folder):
    """A run that takes long enough to lose a host in."""
    (folder / "room.rad").write_text(ROOM)
    return ["render", *VIEW, "-x", "900", "-y", "600", "-ps", "1", "-n", "1", "-ab", "1", "-aa", "0", "-ad", "16",
            "--checkpoint", "kept", "--resume", "-o", "out.hdr", "room.rad"]


def lose_third(cluster, words, settings, launcher=None):
    """A run that loses a host once it has kept something; with its outputs once it is over."""
    process = cluster.start(words, settings, launcher=launcher)
    kept = cluster.folder / "kept"
    while not kept.exists() or kept.stat().st_size < 10000:
        check(process.poll() is None, "the run ended before it kept anything: " + str(process.poll()))
        time.sleep(0.05)
    cluster.cut_off("third")
    return process


def case_lost(cluster):
    """A host that is cut off ends the run, which can be resumed."""
    words = slow_picture(cluster.folder)
    process = lose_third(cluster, words, NOTICES)
    out, err = process.communicate()
    check(process.returncode != 0, "a run that lost a host has ended well")
    check("third" in err, "it is not said which host was lost: " + err)
    check(not (cluster.folder / "out.hdr").exists(), "there is a picture")
    cluster.cut_off("third", False)
    for _ in range(5):  # mpirun may not reach at once a host that has just come back
        status, out, err = cluster.finish(words)
        if "unable to reliably start one or more daemons" not in err:
            break
        time.sleep(2)
    check(status == 0, "the run cannot be resumed: " + err)
    resumed = pixels(cluster.folder / "out.hdr")
    subprocess.run([LIGHTWALK, *words], cwd=cluster.folder, check=True)
    check(pixels(cluster.folder / "out.hdr") == resumed, "the resumed picture is another one")


def case_launched(cluster):
    """A picture that is launched survives a host that is cut off, and has the same bytes."""
    words = slow_picture(cluster.folder)
    hosts = cluster.folder / "named"
    hosts.write_text("".join(f"{host} slots=1\n" for host in HOSTS))
    launch = ["launch", "--hosts", str(hosts), "--retries", "5", *words]
    process = lose_third(cluster, launch, {}, launcher=[])
    out, err = process.communicate()
    check(process.returncode == 0, f"status {process.returncode}: {err}")
    check("third does not answer: goes on without it" in err, err)
    resumed = pixels(cluster.folder / "out.hdr")
    subprocess.run([LIGHTWALK, *words], cwd=cluster.folder, check=True)
    check(pixels(cluster.folder / "out.hdr") == resumed, "the picture is another one")


def case_silent(cluster):
    """Ranks notice by themselves that another one is silent, also where mpirun does not."""
    process = lose_third(cluster, slow_picture(cluster.folder), {})
    line = next((line for line in process.stderr if not is_mpirun_hurry(line)), "")
    check("rank 2 (third): nothing has been heard of it" in line, "what is said first is: " + line)
    ranks = lambda: subprocess.run(["pgrep", "-f", LIGHTWALK + " render"], capture_output=True, text=True).stdout.split()
    left = [p for p in ranks() if p != str(process.pid)]
    end = time.monotonic() + 120
    while [p for p in left if Path(f"/proc/{p}/exe").exists() and os.readlink(f"/proc/{p}/exe") == LIGHTWALK]:
        check(time.monotonic() < end, "ranks are left")
        time.sleep(0.2)


def case_scenes(cluster):
    """Each host reads the scene once; what only the first one has is rendered all the same with --scene-from rank0."""
    folder, here = cluster.folder, cluster.own_folder("first")
    for place in (folder, here):
        (place / "room.rad").write_text(ROOM)
    subprocess.run([LIGHTWALK, "freeze", "-o", here / "frozen", here / "room.rad"], check=True)
    small = ["render", *VIEW, "-x", "60", "-y", "40", "-ps", "1", "-n", "1", "-o", "out.hdr"]
    subprocess.run([LIGHTWALK, *small, "room.rad"], cwd=folder, check=True)
    expected = pixels(folder / "out.hdr")
    for words in (["room.rad"], ["--scene-from", "rank0", "own/room.rad"], ["--scene-from", "rank0", "own/frozen"]):
        (folder / "out.hdr").unlink()
        status, out, err = cluster.finish([*small, *words], ranks=2)
        check(status == 0 and err == "", f"{words}: {status}: {err}")
        check(pixels(folder / "out.hdr") == expected, f"{words}: another picture")


def case_read_once(cluster):
    """Of each host one rank reads a scene of text, and shares it with the others there."""
    folder = cluster.folder
    (folder / "room.rad").write_text(ROOM)
    for host in HOSTS:
        (cluster.own_folder(host) / "told.rad").write_text("!echo read >> own/times; cat room.rad\n")
    small = ["render", *VIEW, "-x", "60", "-y", "40", "-ps", "1", "-n", "1", "--allow-commands", "-o", "out.hdr"]
    for words, times in ([], 1), (["--scene-from", "each"], 2):
        status, out, err = cluster.finish([*small, *words, "own/told.rad"], ranks=2)
        check(status == 0 and err == "", f"{words}: {status}: {err}")
        for host in HOSTS:
            said = cluster.own_folder(host) / "times"
            check(said.read_text() == times * "read\n", f"{words}: {host} has read the scene {len(said.read_text()) // 5} times")
            said.unlink()


def case_frames(cluster):
    """A walk's frames, whose parts are packed between hosts, are those of one process, also where a run goes on."""
    folder = cluster.folder
    (folder / "room.rad").write_text(ROOM)
    words = ["animate", *VIEW, "-x", "90", "-y", "60", "-ps", "1", "-n", "1", "--walk", "turn", "--frames", "5"]
    names = lambda name: [folder / f"{name}{i}.hdr" for i in range(1, 6)]
    whole = [*words, "--reuse", "off"]  # frames that stand for themselves
    for name, more in ("reused", words), ("traced", whole):
        subprocess.run([LIGHTWALK, *more, "-o", "one-" + name + "%d.hdr", "room.rad"], cwd=folder, check=True)
        status, out, err = cluster.finish([*more, "-o", name + "%d.hdr", "room.rad"])
        check(status == 0 and err == "", f"{name}: {status}: {err}")
        for one, frame in zip(names("one-" + name), names(name)):
            check(pixels(frame) == pixels(one), f"{frame.name} is another picture")
    kept = names("traced")[1].read_bytes()
    for frame in names("traced")[2:]:
        frame.unlink()
    status, out, err = cluster.finish([*whole, "--resume", "-o", "traced%d.hdr", "room.rad"])
    check(status == 0 and err == "", f"--resume: {status}: {err}")
    check(names("traced")[1].read_bytes() == kept, "a frame that was there is drawn again")
    for one, frame in zip(names("one-traced"), names("traced")):
        check(pixels(frame) == pixels(one), f"--resume: {frame.name} is another picture")


def case_failure(cluster):
    """What is wrong on two hosts is said once, and nothing else."""
    (cluster.own_folder("first") / "room.rad").write_text(ROOM)
    status, out, err = cluster.finish(["render", *VIEW, "-o", "out.hdr", "own/room.rad"], ranks=2)
    lines = err.splitlines()
    check(status == 1, f"exit status {status}")
    check(len(lines) == 2 and "rank 2 (second): own/room.rad: cannot open" in lines[0], err)
    check("--scene-from rank0" in lines[1], err)


def case_walk(cluster):
    """A walk, whose first rank is on another host than its head, goes on without a host that is cut off, takes it in again when it is back and nobody moves, and
    follows its file of hosts. The page's connection stays, and tells what has happened."""
    from scripted_walk import Client

    folder = cluster.folder
    (folder / "room.rad").write_text(ROOM)
    hosts = folder / "named"
    name = lambda *names: hosts.write_text("".join(f"{host} slots=1\n" for host in names))
    name("second", "third", "first")
    cluster.run("ip addr add 10.77.0.100/24 dev switch")
    launch = cluster.start(["launch", "--hosts", str(hosts), "--retries", "9", "walk", "--port", "8080", "--bind", "0.0.0.0", *VIEW, "-n", "1", "room.rad"], launcher=[])
    try:
        address = launch.stdout.readline()
        check(address.startswith("http://first:8080/?token="), address)
        client = Client(8080, host="10.77.0.1", token=address.strip().split("=")[1])
        ranks = lambda count: client.until(lambda m: isinstance(m, dict) and m["type"] == "state" and m["ranks"] == count)

        def told(said):
            client.until(lambda m: isinstance(m, dict) and m["type"] == "interrupted" and said in m["text"])

        def look():
            client.told("loaded")
            client.look(position=[0, -6, 2], direction=[0, 1, -.2])
            client.frame(client.ident)

        look()
        ranks(3)
        cluster.cut_off("third")
        told("third is lost: the walk begins anew with 2 ranks")
        look()
        ranks(2)
        cluster.cut_off("third", False)
        told("third is there: the walk begins anew with 3 ranks")
        while True:  # mpirun may not reach at once a host that has just come back
            look()
            client.until(lambda m: isinstance(m, dict) and (m["type"] == "state" or m["type"] == "interrupted"))
            if client.messages[-1].get("ranks") == 3:
                break
        name("first", "second")
        told("third is not to be used any more: the walk begins anew with 2 ranks")
        look()
        ranks(2)
    finally:
        launch.terminate()
        errors = launch.communicate()[1]
    check("begins anew with 2 ranks" in errors, errors)


def main():
    enter_namespaces()
    with tempfile.TemporaryDirectory() as folder:
        cluster = Cluster(Path(folder))
        globals()["case_" + sys.argv[2]](cluster)
    print("passed")


if __name__ == "__main__":
    LIGHTWALK = os.path.realpath(sys.argv[1])
    main()

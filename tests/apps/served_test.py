"""Servers of scenes: rtrace by the names of "install-names --serve" answers as the program does that reads the octree itself,
also where a server is of no use, changed, strange or gone.

usage: served_test.py LIGHTWALK
"""

import os
import random
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

LIGHTWALK = Path(sys.argv[1]).resolve()
PATIENCE = 120  # seconds, for what takes one on an idle machine
ROOM = """void plastic white 0 0 5 .7 .7 .7 0 0
void light lamp 0 0 3 {light} 9 9
!genbox white room 4 5 3 -i
lamp polygon ceiling 0 0 12 1 1 2.9 1 2 2.9 2 2 2.9 2 1 2.9
"""
RAYS = b"2 2.5 1 0 0 1\n1 1 1 .3 .2 -1\n" * 5


def wait_for(happens, what):
    end = time.monotonic() + PATIENCE
    while not happens():
        if time.monotonic() > end:
            raise AssertionError(f"not within {PATIENCE} s: {what}")
        time.sleep(0.02)


def living(process):
    """Whether there is such a process, other than as a zombie."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


class Served(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="lightwalk-served-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        runtime = self.folder / "runtime"
        runtime.mkdir(mode=0o700)
        self.sockets = runtime / "lightwalk"
        self.environment = {**os.environ, "XDG_RUNTIME_DIR": str(runtime), "RAYPATH": "."}
        for name in ("OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"):
            self.environment.pop(name, None)
        for names, words in (("names", ["--serve"]), ("plain", [])):
            self.run_words([LIGHTWALK, "install-names", *words, self.folder / names])
        self.environment["PATH"] = f"{self.folder / 'plain'}:{os.environ['PATH']}"
        self.make_octree("room.oct", 9)
        self.servers = []
        self.addCleanup(self.end_servers)

    def end_servers(self):
        shutil.rmtree(self.sockets, ignore_errors=True)  # those that were started by themselves see it, and end
        for server in self.servers:
            server.kill()
            server.wait()
            server.stderr.close()

    def run_words(self, words, **more):
        return subprocess.run([str(word) for word in words], cwd=self.folder, env=self.environment, capture_output=True,
                              check=True, timeout=PATIENCE, **more)

    def make_octree(self, name, light):
        (self.folder / "room.rad").write_text(ROOM.format(light=light))
        octree = self.run_words([self.folder / "plain/oconv", "-f", "room.rad"]).stdout
        whole = self.folder / (name + ".whole")
        whole.write_bytes(octree)
        whole.rename(self.folder / name)

    def serve(self, octree="room.oct", words=()):
        server = subprocess.Popen([LIGHTWALK, "trace", "--serve", *words, octree], cwd=self.folder, env=self.environment,
                                  stdin=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.servers.append(server)
        before = set(self.sockets_there())
        wait_for(lambda: set(self.sockets_there()) - before or server.poll() is not None, "a server")
        return server

    def sockets_there(self):
        return sorted(file for file in self.sockets.glob("*") if file.is_socket())

    def rtrace(self, words, names="names", rays=RAYS, environment=None, prepare=None):
        done = subprocess.run([self.folder / names / "rtrace", *words], cwd=self.folder, input=rays, capture_output=True,
                              env={**self.environment, **(environment or {})}, timeout=PATIENCE, preexec_fn=prepare)
        return done.returncode, done.stdout, done.stderr

    def uses(self, run):
        """What `run` returns, and whether a server was asked."""
        places = self.sockets_there()
        for place in places:
            os.utime(place, (1, 1))
        result = run()
        return result, any(place.exists() and place.stat().st_mtime != 1 for place in places)

    def check_alike(self, words, served=True, **more):
        (status, output, errors), asked = self.uses(lambda: self.rtrace(words, **more))
        expected = self.rtrace(words, "plain", **more)
        self.assertEqual((status, output, errors), expected, words)
        self.assertEqual(asked, served, words)
        return expected

    def test_answers_are_those_of_a_run_that_reads_the_octree(self):
        self.serve()
        for words in (["-h", "room.oct"], ["-h", "-I", "-ab", "1", "room.oct"], ["-h", "-ov", "-oldN", "room.oct"],
                      ["-h", "-fd", "room.oct"], ["-h", "-n", "2", "-ab", "1", "-aa", "0", "room.oct"],
                      ["-h", "-ds", ".01", "-dj", ".7", "room.oct"], ["-h", "-ds", ".01", "-dj", ".7", "room.oct"],
                      ["-h", "-x", "2", "-y", "5", "room.oct"], ["-nonsense", "room.oct"], ["-h", "-oQ", "room.oct"]):
            self.check_alike(words)
        self.check_alike(["-h", "room.oct"], rays=b"1 2 three 4 5 6\n")
        self.check_alike(["-h", "room.oct"], rays=b"")
        header, _ = self.uses(lambda: self.rtrace(["-w", "room.oct"]))
        self.assertIn(b"\nrtrace -w\n", header[1])

    def test_files_that_a_run_makes_are_those_of_its_folder_and_umask(self):
        self.serve()
        _, asked = self.uses(lambda: self.rtrace(["-h", "-ab", "1", "-af", "values.amb", "room.oct"],
                                                 prepare=lambda: os.umask(0o027)))
        self.assertTrue(asked)
        self.assertGreater((self.folder / "values.amb").stat().st_size, 100)
        self.assertEqual((self.folder / "values.amb").stat().st_mode & 0o777, 0o640)

    def test_a_server_starts_at_the_second_run_and_ends_with_its_socket(self):
        self.check_alike(["-h", "room.oct"], served=False)
        self.assertEqual(self.sockets_there(), [])
        self.check_alike(["-h", "room.oct"], served=False)
        wait_for(self.sockets_there, "a server that was started by a run")
        self.check_alike(["-h", "room.oct"])
        started = [int(p.name) for p in Path("/proc").glob("[0-9]*") if self.is_server(p)]
        self.assertTrue(started)
        shutil.rmtree(self.sockets)
        for process in started:
            wait_for(lambda p=process: not living(p), "the end of a server without a socket")

    def is_server(self, process):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
            return b"--serve" in words and Path(os.readlink(process / "cwd")) == self.folder
        except OSError:
            return False

    def test_an_octree_that_changes_ends_its_server(self):
        server = self.serve()
        before = self.check_alike(["-h", "room.oct"])
        self.make_octree("room.oct", 18)
        after = self.rtrace(["-h", "room.oct"], "plain")
        self.assertNotEqual(before, after)
        self.assertEqual(self.rtrace(["-h", "room.oct"]), after)
        self.assertEqual(server.wait(PATIENCE), 0)
        self.assertEqual(self.sockets_there(), [])

    def test_idle_servers_end(self):
        self.assertEqual(self.serve(words=["--idle", ".1"]).wait(PATIENCE), 0)
        self.assertEqual(self.sockets_there(), [])

    def test_the_servers_that_were_not_used_for_longest_make_room(self):
        servers, places = [], []
        for index, used in enumerate((200, 100, 300, 400)):
            self.make_octree(f"room{index}.oct", 9 + index)
            servers.append(self.serve(f"room{index}.oct"))
            places.append(next(place for place in self.sockets_there() if place not in places))
            os.utime(places[-1], (used, used))
        self.serve()
        self.assertEqual(servers[1].wait(PATIENCE), 0)
        self.assertEqual(len(self.sockets_there()), 4)
        self.check_alike(["-h", "room1.oct"], served=False)
        self.check_alike(["-h", "room0.oct"])

    def test_runs_that_a_server_could_not_do_alike_are_done_alone(self):
        self.serve()
        self.check_alike(["-h", "room.oct"], served=False, environment={"RAYPATH": ".:/"})
        self.check_alike(["-h", "./room.oct"], served=False)
        self.check_alike(["-h", str(self.folder / "room.oct")], served=False)
        _, asked = self.uses(lambda: self.rtrace(["-h", "-e", "/dev/fd/2", "room.oct"]))
        self.assertFalse(asked)
        # A server is asked, and declines.
        self.check_alike(["-h", "room.oct"], prepare=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30)))
        self.check_alike(["-h", "room.oct"], prepare=lambda: os.nice(3))
        self.check_alike(["-h", "room.oct"], prepare=lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}))
        self.assertEqual(self.rtrace(["-version"]), self.rtrace(["-version"], "plain"))

    def test_scenes_that_cannot_be_served_are_told_of(self):
        (self.folder / "shell.rad").write_text("!printf '#'\n")
        self.run_words([LIGHTWALK, "freeze", "-o", "room.lwz", "room.oct"])
        for file, why in (("room.lwz", b"frozen scene"), ("missing.oct", b"missing.oct"), ("shell.rad", b"commands")):
            server = self.serve(file)
            self.assertEqual(server.wait(PATIENCE), 1, file)
            self.assertIn(why, server.stderr.read(), file)
        self.serve()
        second = self.serve()
        self.assertEqual(second.wait(PATIENCE), 1)
        self.assertIn(b"room.oct: is served already", second.stderr.read())

    def test_nothing_that_comes_by_the_socket_harms_the_server(self):
        server = self.serve()
        place = str(self.sockets_there()[0])
        chance = random.Random(1)
        silent = []
        for index in range(300):
            client = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            client.connect(place)
            if index % 30 == 0:
                silent.append(client)  # says nothing
                continue
            begin = b"LWserve1" + chance.randbytes(8) + bytes(chance.choices([0, 1, 255], k=24)) if index % 3 else b""
            files = [os.open("/dev/null", os.O_RDONLY) for _ in range(chance.randrange(8))]
            try:
                socket.send_fds(client, [begin + chance.randbytes(chance.randrange(1, 2000))], files)
            except BrokenPipeError:
                pass
            for file in files:
                os.close(file)
            client.close()
        self.check_alike(["-h", "room.oct"])
        for client in silent:
            client.close()
        self.assertIsNone(server.poll())

    def test_a_run_ends_with_whoever_asked(self):
        server = self.serve()
        read, write = os.pipe()
        client = subprocess.Popen([self.folder / "names/rtrace", "-h", "room.oct"], cwd=self.folder, env=self.environment,
                                  stdin=read, stdout=subprocess.DEVNULL)
        os.close(read)
        runs = lambda: [int(child) for child in Path(f"/proc/{server.pid}/task/{server.pid}/children").read_text().split()]
        wait_for(lambda: len(runs()) == 2, "the run and the one that waits for the next")
        client.kill()
        client.wait()
        wait_for(lambda: len(runs()) == 1, "the end of the run")  # although its rays have not ended
        os.close(write)
        self.check_alike(["-h", "room.oct"])

    def test_a_run_that_is_killed_is_told_of_as_that(self):
        server = self.serve()
        read, write = os.pipe()
        client = subprocess.Popen([self.folder / "names/rtrace", "-h", "room.oct"], cwd=self.folder, env=self.environment,
                                  stdin=read, stdout=subprocess.PIPE)
        os.close(read)
        os.write(write, b"2 2.5 1 0 0 1\n0 0 0 0 0 0\n")  # the answers come when a row is zero
        self.assertTrue(client.stdout.readline())
        run = max(Path(f"/proc/{server.pid}/task/{server.pid}/children").read_text().split(), key=self.reads_pipe)
        os.kill(int(run), signal.SIGKILL)
        self.assertEqual(client.wait(PATIENCE), -signal.SIGKILL)
        client.stdout.close()
        os.close(write)
        self.check_alike(["-h", "room.oct"])

    @staticmethod
    def reads_pipe(process):
        return os.readlink(f"/proc/{process}/fd/0").startswith("pipe:")

    def test_a_closed_output_ends_a_run_as_it_ends_a_program(self):
        self.serve()
        for names in ("names", "plain"):
            client = subprocess.Popen([self.folder / names / "rtrace", "-h", "room.oct"], cwd=self.folder,
                                      env=self.environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
            client.stdout.close()
            client.stdin.write(RAYS * 100)
            client.stdin.close()
            self.assertEqual(client.wait(PATIENCE), -signal.SIGPIPE, names)

    def test_folders_of_others_are_not_used(self):
        self.serve()
        self.sockets.chmod(0o777)
        second = self.serve()
        self.assertEqual(second.wait(PATIENCE), 1)
        self.assertIn(b"expected a folder of this user alone", second.stderr.read())
        long_name = self.folder / ("x" * 120)
        long_name.mkdir(mode=0o700)
        self.check_alike(["-h", "room.oct"], served=False, environment={"XDG_RUNTIME_DIR": str(long_name)})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)

#!/usr/bin/python3
"""How a walk over several hosts keeps up with a client: live_walk.py on three network namespaces, joined by links of a given delay.

  hosts_walk.py [--delay MS] LIGHTWALK [options of live_walk.py]

--delay is one way, from host to host; the client is beside rank 0. Needs root, and ethtool. Packets are forwarded by this script, which
takes a part of one core."""
import heapq, os, pathlib, select, shutil, socket, subprocess, sys, tempfile, threading, time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests/apps"))

import hosts_test as hosts  # noqa: E402

MTU = 60000  # what one packet costs here is much more than on a wire, so there are few


class Switch(threading.Thread):
    """Forwards what comes on each link to the host that it is for, `delay` seconds later."""

    def __init__(self, links, delay):
        super().__init__(daemon=True)
        self.delay, self.ports = delay, {}
        for link in links:
            port = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
            port.bind((link, 0))
            port.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 26)
            self.ports[port.fileno()] = port
        self.known = {}  # address: port
        self.waiting = []  # (when, number, port it came from, packet)

    def run(self):
        poll, number = select.poll(), 0
        for fd in self.ports:
            poll.register(fd, select.POLLIN)
        while True:
            left = self.waiting[0][0] - time.monotonic() if self.waiting else 1
            for fd, _ in poll.poll(max(0, 1000 * left)):
                packet, (_, _, kind, *_) = self.ports[fd].recvfrom(1 << 17)
                if kind == socket.PACKET_OUTGOING:
                    continue
                self.known[packet[6:12]] = fd
                number += 1
                heapq.heappush(self.waiting, (time.monotonic() + self.delay, number, fd, packet))
            while self.waiting and self.waiting[0][0] <= time.monotonic():
                _, _, source, packet = heapq.heappop(self.waiting)
                for fd in [self.known[packet[:6]]] if packet[:6] in self.known else [fd for fd in self.ports if fd != source]:
                    self.ports[fd].send(packet)


def main(words):
    delay = float(words.pop(words.index("--delay") + 1)) if "--delay" in words else 0
    if "--delay" in words:
        words.remove("--delay")
    program = os.path.realpath(words.pop(0))
    if shutil.which("ethtool") is None:
        hosts.skip("no ethtool")
    with tempfile.TemporaryDirectory() as folder:
        cluster = hosts.Cluster(pathlib.Path(folder))
        links = [f"link{i}" for i in range(len(hosts.HOSTS))]
        for link, process in zip(links, cluster.processes.values()):
            inside = f"nsenter -t {process} -n"
            cluster.run(f"ip link set {link} nomaster", f"ip link set {link} mtu {MTU}", f"{inside} ip link set eth0 mtu {MTU}")
            for command in (f"{inside} ethtool -K eth0 tx off tso off gso off gro off", f"ethtool -K {link} gro off"):
                subprocess.run(command.split(), check=True, stdout=subprocess.DEVNULL)
        Switch(links, delay / 1000).start()
        first = cluster.processes[hosts.HOSTS[0]]
        launcher = f"mpirun --host {','.join(name + ':1' for name in hosts.HOSTS)} -n {len(hosts.HOSTS)} -x RAYPATH"
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                           OMPI_MCA_plm_rsh_agent=str(cluster.agent), OMPI_MCA_orte_tmpdir_base=folder)
        done = subprocess.run(["nsenter", "-t", str(first), "-n", "-u", "-m", "--wdns=" + os.getcwd(), sys.executable, str(HERE / "live_walk.py"), "--lightwalk", program,
                               "--launcher", launcher, *words], env=environment)
        sys.exit(done.returncode)


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    hosts.enter_namespaces()
    main(sys.argv[1:])

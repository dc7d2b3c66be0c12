"""A link between a client and the server of a walk that is as narrow and as long as one of the Internet."""
import socket, threading, time

#: What lies in the system's own buffers is on its way too, and would hide the link's width [bytes].
BUFFER = 16384


class SlowLink(threading.Thread):
    """A proxy for one connection that carries so many bytes a second from the server, and lets both directions wait for half of the delay [s]."""

    def __init__(self, port, bytes_per_second, delay):
        super().__init__(daemon=True)
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.target, self.rate, self.delay = port, bytes_per_second, delay

    def run(self):
        near, _ = self.listener.accept()
        far = socket.socket()
        far.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
        far.connect(("127.0.0.1", self.target))
        for end in (near, far):
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        threading.Thread(target=self.carry, args=(near, far, 1e9), daemon=True).start()
        self.carry(far, near, self.rate)

    def carry(self, source, sink, rate):
        queue, ready = [], threading.Condition()

        def deliver():
            while True:
                with ready:
                    while not queue:
                        ready.wait()
                    due, data = queue.pop(0)
                time.sleep(max(0, due - time.monotonic()))
                try:
                    sink.sendall(data)
                except OSError:
                    return

        threading.Thread(target=deliver, daemon=True).start()
        free = time.monotonic()
        while True:
            try:
                data = source.recv(4096)
            except OSError:
                return
            if not data:
                return
            free = max(free, time.monotonic()) + len(data) / rate
            time.sleep(max(0, free - time.monotonic()))
            with ready:
                queue.append((free + self.delay / 2, data))
                ready.notify()

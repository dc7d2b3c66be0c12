"""A WebSocket client of a few lines (RFC 6455), for measuring and testing `lightwalk walk`: whole messages, no extensions."""
import base64, json, os, select, socket, struct


class Closed(Exception):
    """The server closed the connection."""


class WebSocket:
    """A connection to host:port, for one thread."""

    def __init__(self, host, port, path="/walk", origin=None, timeout=10):
        self.socket = socket.create_connection((host, port), timeout)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.timeout, self.buffer = timeout, b""
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET {path} HTTP/1.1", f"Host: {host}:{port}", "Upgrade: websocket", "Connection: Upgrade",
                 f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"] + ([f"Origin: {origin}"] if origin else [])
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.buffer:
            self._more()
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])
        if self.status != 101:
            raise Closed(head.decode(errors="replace").splitlines()[0])

    def _more(self):
        data = self.socket.recv(1 << 20)
        if not data:
            raise Closed("end of stream")
        self.buffer += data

    def _take(self, count):
        while len(self.buffer) < count:
            self._more()
        taken, self.buffer = self.buffer[:count], self.buffer[count:]
        return taken

    def send_raw(self, opcode, payload):
        mask = os.urandom(4)
        size = len(payload)
        head = bytes([0x80 | opcode])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        masked = bytes(byte ^ mask[k & 3] for k, byte in enumerate(payload))
        self.socket.sendall(head + mask + masked)

    def send(self, message):
        self.send_raw(1, json.dumps(message).encode())

    def waits(self, seconds):
        """Whether a message arrives within that time."""
        return bool(self.buffer) or bool(select.select([self.socket], [], [], max(seconds, 0))[0])

    def receive(self):
        """The next message: the bytes of a binary one, or the value of a JSON text."""
        whole, kind = b"", 0
        while True:
            first, second = self._take(2)
            size = second & 127
            if size == 126:
                (size,) = struct.unpack(">H", self._take(2))
            elif size == 127:
                (size,) = struct.unpack(">Q", self._take(8))
            payload = self._take(size)
            opcode = first & 15
            if opcode == 8:
                raise Closed(payload[2:].decode(errors="replace"))
            if opcode == 9:
                self.send_raw(10, payload)
            if opcode >= 8:
                continue
            kind = opcode or kind
            whole += payload
            if first & 0x80:
                return whole if kind == 2 else json.loads(whole)

    def close(self):
        self.socket.close()


class Frame:
    """Decode a binary message, whose layout is in io/net/README.md."""

    def __init__(self, message):
        magic, self.number, self.view, self.width, self.height, flags, _, self.pieces, self.exposure = \
            struct.unpack_from("<4sIIHHBBHf", message)
        if magic != b"LWF1":
            raise ValueError("no frame")
        self.eye = struct.unpack_from("<ddd", message, 24)
        self.whole, self.at_rest, self.finished, self.denoised = (bool(flags & bit) for bit in (1, 2, 4, 8))
        self.bytes = len(message)
        self.message = message

    def parts(self):
        """The bytes of its pieces, by (codec, x, y, width, height)."""
        found, at = {}, 48
        for _ in range(self.pieces):
            *place, codec, size = struct.unpack_from("<HHHHB3xI", self.message, at)
            found[codec, *place] = self.message[at + 16:at + 16 + size]
            at += 16 + size
        return found

"""Abusive clients for tests of a walk's server."""
import random, socket, time

from walk.websocket import Closed, WebSocket

VIEW = {"type": "v", "position": [0, -4, 1.5], "direction": [0, 1, -0.05], "up": [0, 0, 1], "horizontal": 60, "vertical": 46.8}
SHAPES = [b"", b"{", b"null", b"[[[[[[[[[[[[[[", b'{"type":"view"}', b'{"type":"hello","session":1}', b"\xff\xfe" * 100, b"x" * 70000,
          b'{"type":"edits","id":1,"materials":[{"name":"grey","definition":0,"kind":"plastic","reals":[1e300]}]}',
          b'{"type":"edits","id":1,"materials":[{"name":"grey","definition":4294967295,"kind":"light","reals":[-1]}]}',
          b'{"type":"material","id":1,"x":0.5,"y":7}']
VIEWS = [{"width": -1}, {"width": 1e9}, {"view": {**VIEW, "direction": [0, 0, 0]}}, {"view": {**VIEW, "horizontal": 1e30}},
         {"view": {**VIEW, "position": ["NaN", 0, 0]}}, {"id": -5}]


def misbehave(port, chance, session, patience=60):
    """Send random and malformed messages until the server disconnects; returns their number."""
    sent = 0
    try:
        bad = WebSocket("127.0.0.1", port, timeout=patience)
        if chance.random() < 0.7:
            bad.send({"type": "hello", "session": session})
        for sent in range(20):
            draw = chance.random()
            if draw < 0.3:
                bad.send_raw(1, chance.choice(SHAPES))
            elif draw < 0.6:
                bad.send({"type": "view", "id": 1, "view": VIEW, "width": 10, "height": 10, "moving": False, "walk": False,
                          **chance.choice(VIEWS)})
            elif draw < 0.8:
                bad.send_raw(chance.randrange(16), chance.randbytes(chance.randrange(200)))
            else:
                bad.socket.sendall(chance.randbytes(50))
        bad.socket.close()
    except (Closed, OSError):
        pass
    return sent + 1


def keep_misbehaving(port, counts, connections=200, rate=1000):
    """Hold half-open connections, and send so many messages a second, until the process is ended; counts them."""
    chance = random.Random(1)
    held = [socket.create_connection(("127.0.0.1", port)) for _ in range(connections)]
    start = time.monotonic()
    while held:
        counts.value += misbehave(port, chance, f"{chance.randrange(1 << 60):016x}")
        time.sleep(max(0.0, counts.value / rate - (time.monotonic() - start)))

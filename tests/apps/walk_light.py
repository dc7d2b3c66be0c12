"""Cases of walk_server_test.py: numbers of light that a walk tells."""
import base64, math, struct, subprocess

from scripted_walk import Client, Server


def light(program):
    """What is pointed at: a panel of known luminance, its name, the mean, glare; where nothing is, nothing is hit."""
    with Server(program) as server:
        client = Client(server.port)
        client.enter()
        picked = client.ask("pick", "picked", x=0.67, y=0.52)
        assert picked["hit"] and picked["material"] == "panel" and picked["surface"] == "screen", picked
        assert abs(picked["luminance"] - 358) < 0.02 * 358, picked
        assert abs(picked["position"][1] - 5.9) < 0.001 and picked["normal"] == [0, -1, 0], picked
        floor = client.ask("pick", "picked", x=0.5, y=0.1)
        # Diffuse: the luminance is the illuminance times the reflectance over pi.
        assert abs(floor["luminance"] - floor["illuminance"] * 0.5 / 3.14159) < 0.05 * floor["luminance"], floor
        assert not client.ask("pick", "picked", x=0.05, y=0.95)["hit"]
        mean = client.ask("rectangle", "mean", rect=[0.66, 0.5, 0.68, 0.54])
        assert abs(mean["luminance"] - 358) < 0.02 * 358 and mean["pixels"] > 0, mean
        client.socket.send({"type": "probes", "probes": [{"id": 7, "position": floor["position"], "normal": floor["normal"]}]})
        probe = client.told("probes")["probes"][0]
        assert probe["id"] == 7 and abs(probe["illuminance"] - floor["illuminance"]) < 0.05 * floor["illuminance"], probe
        client.ident += 1
        client.socket.send({"type": "glare", "id": client.ident})
        glare = client.told("glare", id=client.ident, done=1)
        assert 0 <= glare["dgp"] <= 1, glare
        isolux_as_traced(program, server, client)


def isolux_as_traced(program, server, client):
    """The illuminances on a level plane are those that `trace -I` computes at its points."""
    client.ident += 1
    client.socket.send({"type": "isolux", "id": client.ident, "position": [0, -4, 1.5], "height": 0.75})
    grid = client.told("isolux", id=client.ident, done=1)
    columns, rows = grid["columns"], grid["rows"]
    assert 30 <= columns <= 35 and rows == 48 and grid["normal"] == [0, 0, 1], grid
    values = struct.unpack(f"<{columns * rows}f", base64.b64decode(grid["values"]))
    place = lambda k: [o + k % columns * a + k // columns * b for o, a, b in zip(grid["origin"], grid["across"], grid["along"])]  # noqa: E731
    points = {k: place(k) for k, lux in enumerate(values) if lux == lux}
    for k in range(columns * rows):  # what is over the floor counts, but for what is within the ball
        x, y, _ = place(k)
        assert (k in points) == (abs(x) < 4 and abs(y) < 6 and math.dist(place(k), (-1, 2, 0.7)) > 0.7), place(k)
    sensors = "".join(f"{x} {y} {z} 0 0 1\n" for x, y, z in points.values())
    options = "-dt .05 -dc .5 -ds .25 -dr 1"  # those that walk has, as rpict, and trace has not, as rtrace
    traced = subprocess.run([program, "trace", "-h", "-I", *options.split(), server.scene], input=sensors, capture_output=True, text=True, check=True).stdout
    lux = [179 * (0.265106 * r + 0.670106 * g + 0.064788 * b) for r, g, b in (map(float, line.split()) for line in traced.splitlines())]
    mean = sum(lux) / len(lux)
    worst = max(abs(values[k] - wanted) for k, wanted in zip(points, lux))
    assert worst < 1e-4 * mean, (worst, mean)
    assert abs(grid["mean"] - mean) < 1e-4 * mean and grid["mean_95"] < 1e-6 * mean, (grid["mean"], grid["mean_95"], mean)
    assert abs(grid["least"] - min(lux)) < 1e-4 * mean and abs(grid["most"] - max(lux)) < 1e-4 * mean, (grid["least"], grid["most"])
    assert grid["least_95"] == grid["most_95"] == 0, grid


def intervals(program):
    """Each number of light comes with its 95 % interval, which narrows at pins and holds what `trace --interval` finds; without chance it is nothing."""
    options = "-dt .05 -dc .5 -ds .25 -dr 1 -ab 2 -as 0".split()
    with Server(program, [*options, "-aa", ".15", "-ad", "512"]) as server:
        client = Client(server.port)
        client.enter()
        pins = [[0.5, 0, 0, 0, 0, 1], [2, 5.9999, 0.3, 0, -1, 0]]
        client.socket.send({"type": "probes", "probes": [{"id": k, "position": pin[:3], "normal": pin[3:]} for k, pin in enumerate(pins)]})
        first = client.told("probes")
        last = client.told("probes", settled=1)
        exact = ["-aa", "0", "-ad", "1024", "-lw", "1e-7", "--interval", "16"]
        traced = subprocess.run([program, "trace", "-h", "-I", *options, *exact, server.scene], stdout=subprocess.PIPE, text=True, check=True,
                                input="".join(" ".join(map(str, pin)) + "\n" for pin in pins)).stdout
        luminous = lambda rgb: 179 * sum(a * b for a, b in zip((0.265106, 0.670106, 0.064788), rgb))  # noqa: E731
        for early, late, line in zip(first["probes"], last["probes"], traced.splitlines(), strict=True):
            rgb = [float(word) for word in line.split()]
            truth, half = luminous(rgb[:3]), luminous(rgb[3:])
            assert half < 0.01 * truth, (truth, half)
            for told in (early, late):
                assert abs(told["illuminance"] - truth) < 2 * told["illuminance_95"] + half, (told, truth)
            for name in ("illuminance", "luminance"):
                assert 0 < late[name + "_95"] <= early[name + "_95"] and late[name + "_95"] < 0.02 * late[name], (name, early, late)
        client.told("state", phase="done")
        floor = client.ask("pick", "picked", x=0.5, y=0.1)
        for name in ("luminance", "illuminance"):
            assert 0 < floor[name + "_95"] < 0.3 * floor[name], floor
        mean = client.ask("rectangle", "mean", rect=[0.3, 0, 0.7, 0.3])
        assert 0 < mean["luminance_95"] < 0.1 * mean["luminance"], mean
        client.ident += 1
        client.socket.send({"type": "glare", "id": client.ident})
        glare = client.told("glare", id=client.ident, done=1)
        assert 0 < glare["dgp_95"] < 0.05, glare
    with Server(program) as server:  # direct light, whose places are not random
        client = Client(server.port)
        client.enter()
        client.socket.send({"type": "probes", "probes": [{"id": 1, "position": [0.5, 0, 0], "normal": [0, 0, 1]}]})
        pin = client.told("probes")["probes"][0]
        assert pin["illuminance"] > 0 and pin["illuminance_95"] == pin["luminance_95"] == 0, pin

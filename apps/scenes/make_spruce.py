#!/usr/bin/python3
"""Write lodge/spruce.oct: a spruce as a frozen Radiance octree, to be instanced.

The tree is 6 m high, its foot at the origin: a trunk, whorls of drooping branches, each a cone with sprays of
needles as triangles. The layout of the file follows Radiance's octree format (files(5), oconv(1)).
"""
import math, pathlib, random, struct

TYPES = ["cone", "polygon", "plastic", "brightfunc"]
CUBE = (-2.0, -2.0, -0.25, 6.5)  # origin and edge
MAX_DEPTH, MAX_IN_LEAF = 5, 40


def portable_float(x):
    if x == 0:
        return struct.pack(">ib", 0, 0)
    mantissa, exponent = math.frexp(x)
    return struct.pack(">ib", int(mantissa * 2147483647), exponent)


def record(type_name, modifier, name, strings, reals):
    out = struct.pack(">bi", TYPES.index(type_name), modifier) + name.encode() + b"\0"
    out += struct.pack(">H", len(strings)) + b"".join(s.encode() + b"\0" for s in strings)
    return out + struct.pack(">H", len(reals)) + b"".join(portable_float(x) for x in reals)


def spruce():
    """(type, modifier index, reals) of every surface: modifiers 1 (bark) and 2 (needles)."""
    rng = random.Random(7)
    surfaces = [("cone", 1, [0, 0, -0.2, 0, 0, 5.9, 0.11, 0.01])]
    height = 0.7
    while height < 5.8:
        reach = 1.75 * (1 - height / 6.0) ** 0.8 + 0.08
        count = 9 if height < 4.5 else 6
        turn = rng.uniform(0, math.tau)
        for k in range(count):
            a = turn + math.tau * (k + rng.uniform(-0.2, 0.2)) / count
            length = reach * rng.uniform(0.8, 1.1)
            tip = (length * math.cos(a), length * math.sin(a), height - 0.28 * length + rng.uniform(-0.05, 0.05))
            surfaces.append(("cone", 1, [0, 0, height, *tip, 0.018, 0.004]))
            surfaces += sprays(rng, height, a, length, tip)
        height += 0.22 + 0.06 * (1 - height / 6)
    surfaces.append(("cone", 2, [0, 0, 5.5, 0, 0, 6.1, 0.07, 0.0]))
    return surfaces


def sprays(rng, height, angle, length, tip):
    """Triangles of needles on both sides of a branch, drooping towards the tip."""
    out = []
    side = (-math.sin(angle), math.cos(angle))
    steps = max(3, int(length / 0.16))
    for i in range(1, steps + 1):
        t = i / steps
        base = [tip[0] * t, tip[1] * t, height + (tip[2] - height) * t]
        width = 0.34 * length * (1.15 - t) + 0.05
        back = 0.22 * length
        for sign in (-1, 1):
            w = sign * width * rng.uniform(0.8, 1.2)
            out.append(("polygon", 2, [
                *base,
                base[0] + side[0] * w + math.cos(angle) * 0.1, base[1] + side[1] * w + math.sin(angle) * 0.1,
                base[2] - rng.uniform(0.05, 0.14),
                base[0] - math.cos(angle) * back, base[1] - math.sin(angle) * back, base[2] + rng.uniform(0.0, 0.05)]))
    return out


def bounds(surface):
    kind, _, r = surface
    pad = max(r[6:8]) if kind == "cone" else 0.0
    points = [r[i:i + 3] for i in range(0, 6 if kind == "cone" else len(r), 3)]
    return [min(p[k] for p in points) - pad for k in range(3)], [max(p[k] for p in points) + pad for k in range(3)]


def tree(boxes, ids, origin, size, depth):
    """Pre-order octree bytes for the surfaces `ids` that touch this cube."""
    inside = [i for i in ids if all(boxes[i][0][k] <= origin[k] + size and boxes[i][1][k] >= origin[k] for k in range(3))]
    if not inside:
        return b"\0"
    if len(inside) <= MAX_IN_LEAF or depth == MAX_DEPTH:
        return b"\1" + struct.pack(f">{len(inside) + 1}I", len(inside), *inside)
    half = size / 2
    return b"\2" + b"".join(
        tree(boxes, inside, [origin[k] + half * (child >> k & 1) for k in range(3)], half, depth + 1)
        for child in range(8))


def main():
    surfaces = spruce()
    records = [record("brightfunc", -1, "needle_shade", [".75+.5*rand(floor(Px*9)+7*floor(Py*9)+31*floor(Pz*9))", "."], []),
               record("plastic", -1, "bark", [], [0.13, 0.09, 0.06, 0, 0]),
               record("plastic", 0, "needles", [], [0.05, 0.11, 0.045, 0.01, 0.1])]
    first = len(records)
    records += [record(kind, modifier, f"s{i}", [], reals) for i, (kind, modifier, reals) in enumerate(surfaces)]
    boxes = {first + i: bounds(s) for i, s in enumerate(surfaces)}
    data = b"#?RADIANCE\nmake_spruce.py\nFORMAT=Radiance_octree\n\n" + struct.pack(">h", 287)
    data += b"".join(f"{x:.12g}".encode() + b"\0" for x in CUBE) + b"\0" + struct.pack(">I", len(records))
    data += tree(boxes, sorted(boxes), list(CUBE[:3]), CUBE[3], 0)
    data += b"".join(t.encode() + b"\0" for t in TYPES) + b"\0" + b"".join(records) + b"\xff"
    path = pathlib.Path(__file__).resolve().parent / "lodge" / "spruce.oct"
    path.write_bytes(data)
    print(f"{path.name}: {len(surfaces)} surfaces, {len(data)} bytes")


main()

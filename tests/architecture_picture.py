#!/usr/bin/python3
"""Draws core/architecture.svg: the folders core, parallel, io and apps, their rooms (subfolders), and who includes whom.

    architecture_picture.py            writes the picture; architecture_test.py fails while it is out of date

The arrows come from the #include lines, the line of text in each room from the table of rooms in its folder's README.md
(a row is "| `room/` | what it is: details |"; the text up to the first colon is shown). An arrow that follows from others is
not drawn: where a includes b and b includes c, whether a includes c too makes no difference to the picture.

The layout is the layered one of Sugiyama, Tagawa & Toda, "Methods for Visual Understanding of Hierarchical System Structures"
(1981): rooms on layers, arrows down, the order within layers by barycentres and swaps of neighbours that save crossings.
It is deterministic, and depends on nothing but the graph and the texts."""
import html, pathlib, re, sys, textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE = "core/architecture.svg"
COMMAND = "tests/architecture_picture.py"
TOPS = ("apps", "parallel", "io", "core")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
ROW = re.compile(r"^\| `([\w*./]+)` \| ([^|]+) \|", re.M)
LEAVE_OUT = {"pictures"}  # folders that hold no part of the program


def sources(folder):
    return [path for path in sorted(folder.rglob("*")) if path.suffix in (".h", ".cpp")]


def subfolder(name):
    """The room of a file: "picture" for "io/picture/picture.h", "." for "core/error.h", which lies in no subfolder."""
    parts = name.split("/")
    return parts[1] if len(parts) > 2 else "."


def include_graph(root):
    """{(top, room): {(top, room) that it includes}} of all rooms, those without sources too."""
    graph = {}
    for top in TOPS:
        for path in sorted((root / top).iterdir()) if (root / top).is_dir() else ():
            if path.is_dir() and path.name not in LEAVE_OUT and not path.name.startswith((".", "__")):
                graph[top, path.name] = set()
        for path in sources(root / top):
            room = (top, subfolder(str(path.relative_to(root))))
            graph.setdefault(room, set())
            for kind, name in INCLUDE.findall(path.read_text()):
                other = (name.split("/")[0], subfolder(name))
                if kind == '"' and other[0] in TOPS and other != room:
                    graph[room].add(other)
    return graph


def captions(root):
    """{(top, room): the first words of its row in the README of the folder}."""
    texts = {}
    for top in TOPS:
        readme = root / top / "README.md"
        for name, text in ROW.findall(readme.read_text()) if readme.is_file() else ():
            room = "." if name.startswith("*") else name.strip("/")
            texts[top, room] = re.split(r"[:;]", re.sub(r"[`*]|\]\([^)]*\)|\[", "", text))[0].strip()
    return texts


def lines_of(caption):
    """A caption in lines of at most LETTERS letters, as even as they can be."""
    fewest = len(textwrap.wrap(caption, LETTERS))
    width = next(width for width in range(1, LETTERS + 1) if len(textwrap.wrap(caption, width)) <= fewest)
    return textwrap.wrap(caption, width)


# ---------------------------------------------------------------------------------------------------------- layout

ROOM_WIDTH, ROOM_HEIGHT, GAP, LAYER_PITCH = 142, 46, 14, 78
LETTERS = 24  # of a caption's line


class Layout:
    """Places the rooms of one folder: `place[room]` is (x of the middle, y of the top), `routes[a, b]` the points that an
    arrow passes, `circles` the arrows that point up because the rooms include each other in a circle."""

    def __init__(self, rooms, edges):
        self.linked = set(edges) & {room for room in rooms if edges[room]} | {b for targets in edges.values() for b in targets}
        self.rooms = sorted(self.linked)
        self.circles = self.find_circles(edges)
        below = {room: sorted(edges.get(room, set()) - {b for a, b in self.circles if a == room}) for room in self.rooms}
        self.level = {}
        for room in self.rooms:
            self.find_level(room, below)
        self.below = {room: [b for b in below[room] if not self.follows(room, b, below)] for room in self.rooms}
        self.make_layers()
        self.order_layers()
        self.place_layers()
        self.place_alone(sorted(set(rooms) - self.linked))

    def find_circles(self, edges):
        """Arrows back to a room on the path of a depth-first search: without them there is no circle."""
        back, done, path = set(), set(), []

        def visit(room):
            path.append(room)
            for other in sorted(edges.get(room, ())):
                if other in path:
                    back.add((room, other))
                elif other not in done:
                    visit(other)
            done.add(path.pop())

        included = {b for targets in edges.values() for b in targets}
        for room in sorted(self.rooms, key=lambda r: (r in included, r)):
            if room not in done:
                visit(room)
        return back

    def find_level(self, room, below):
        if room not in self.level:
            self.level[room] = max((self.find_level(b, below) + 1 for b in below[room]), default=0)
        return self.level[room]

    def follows(self, a, b, below):
        """Whether another room that a includes leads to b."""
        seen, stack = set(), [c for c in below[a] if c != b]
        while stack:
            room = stack.pop()
            if room == b:
                return True
            if room not in seen:
                seen.add(room)
                stack += below[room]
        return False

    def make_layers(self):
        """Layers from the lowest; an arrow that passes a layer has a node (a, b, layer) of no width there."""
        self.layers = [[] for _ in range(max(self.level.values(), default=0) + 1)]
        self.up, self.down = {}, {}
        for room in self.rooms:
            self.layers[self.level[room]].append(room)
        self.chains = {}
        for a in self.rooms:
            for b in self.below[a]:
                chain = [a, *((a, b, k) for k in range(self.level[a] - 1, self.level[b], -1)), b]
                self.chains[a, b] = chain
                for node in chain[1:-1]:
                    self.layers[node[2]].append(node)
                for high, low in zip(chain, chain[1:]):
                    self.down.setdefault(high, []).append(low)
                    self.up.setdefault(low, []).append(high)

    def crossings(self, layers):
        count = 0
        for low, high in zip(layers, layers[1:]):
            position = {node: k for k, node in enumerate(low)}
            ends = [position[b] for a in high for b in sorted(self.down.get(a, ()), key=position.get)]
            count += sum(x > y for k, x in enumerate(ends) for y in ends[k + 1:])
        return count

    def order_layers(self):
        best, fewest = [list(layer) for layer in self.layers], self.crossings(self.layers)
        layers = [list(layer) for layer in self.layers]
        for sweep in range(24):
            upward = sweep % 2 == 0
            indices = range(1, len(layers)) if upward else range(len(layers) - 2, -1, -1)
            for k in indices:
                fixed = {node: i for i, node in enumerate(layers[k - 1 if upward else k + 1])}
                old = {node: i for i, node in enumerate(layers[k])}
                links = self.down if upward else self.up

                def barycentre(node):
                    near = [fixed[other] for other in links.get(node, ())]
                    return (sum(near) / len(near) if near else old[node], old[node])

                layers[k].sort(key=barycentre)
            self.swap_neighbours(layers)
            count = self.crossings(layers)
            if count < fewest:
                best, fewest = [list(layer) for layer in layers], count
        self.layers = best

    def swap_neighbours(self, layers):
        count = self.crossings(layers)
        improved = True
        while improved:
            improved = False
            for layer in layers:
                for k in range(len(layer) - 1):
                    layer[k], layer[k + 1] = layer[k + 1], layer[k]
                    now = self.crossings(layers)
                    if now < count:
                        count, improved = now, True
                    else:
                        layer[k], layer[k + 1] = layer[k + 1], layer[k]

    def place_layers(self):
        width = lambda node: ROOM_WIDTH if node in self.level else 10
        x = {}
        for layer in self.layers:
            for k, node in enumerate(layer):
                x[node] = k * (ROOM_WIDTH + GAP) - (len(layer) - 1) * (ROOM_WIDTH + GAP) / 2
        for sweep in range(60):
            for layer in self.layers if sweep % 2 else reversed(self.layers):
                wanted = []
                for node in layer:
                    # Within a long arrow eight times the weight: it becomes straight there.
                    near = [(x[other], 1 if node in self.level or other in self.level else 8)
                            for other in (*self.up.get(node, ()), *self.down.get(node, ()))]
                    wanted.append(sum(place * weight for place, weight in near) / sum(weight for _, weight in near))
                gaps = [(width(a) + width(b)) / 2 + GAP for a, b in zip(layer, layer[1:])]
                x.update(zip(layer, spread(wanted, gaps)))
        left = min((x[room] for room in self.rooms), default=0) - ROOM_WIDTH / 2
        self.width = max((x[node] for node in x), default=0) + ROOM_WIDTH / 2 - left
        self.height = (len(self.layers) - 1) * LAYER_PITCH + ROOM_HEIGHT
        y = lambda level: (len(self.layers) - 1 - level) * LAYER_PITCH
        self.place = {room: (x[room] - left, y(self.level[room])) for room in self.rooms}
        self.routes = {}
        for edge, chain in self.chains.items():
            self.routes[edge] = [(x[node] - left, y(node[2] if node not in self.level else self.level[node])) for node in chain]

    def place_alone(self, alone):
        """Rooms that include no room of the folder, and are included by none: columns on the right, from the bottom."""
        self.rooms = sorted([*self.rooms, *alone])
        for k, room in enumerate(alone):
            column, row = divmod(k, len(self.layers))
            if row == 0:
                self.width += (ROOM_WIDTH + 2 * GAP) if self.linked or column else 0
            self.place[room] = (self.width - ROOM_WIDTH / 2, self.height - ROOM_HEIGHT - row * LAYER_PITCH)


def spread(wanted, gaps):
    """Places at least `gaps` apart, in order, with the least sum of squared distances to `wanted` (isotonic regression)."""
    offsets = [0.0]
    for gap in gaps:
        offsets.append(offsets[-1] + gap)
    pools = []  # [sum, count]
    for place, offset in zip(wanted, offsets):
        pools.append([place - offset, 1])
        while len(pools) > 1 and pools[-2][0] / pools[-2][1] > pools[-1][0] / pools[-1][1]:
            total, count = pools.pop()
            pools[-1][0] += total
            pools[-1][1] += count
    means = [total / count for total, count in pools for _ in range(count)]
    return [mean + offset for mean, offset in zip(means, offsets)]


# --------------------------------------------------------------------------------------------------------- drawing

FILLS = {"apps": "#fdf1e3", "parallel": "#e8f0fb", "io": "#eaf6ea", "core": "#f4eefb"}
INKS = {"apps": "#b5651d", "parallel": "#2f62a8", "io": "#3a7d3a", "core": "#6b4aa0"}
TITLES = {"apps": "the programs", "parallel": "who computes what, and when", "io": "bytes to values and back",
          "core": "light, one ray at a time: no threads, no files"}
PADDING, HEAD, BETWEEN = 18, 34, 46


def arrow(points, ink, dashed=False):
    """A path from the lower edge of the first room through the middle of each layer to the upper edge of the last."""
    (x, y), *rest = points
    y += ROOM_HEIGHT
    path = [f"M{x:.1f} {y:.1f}"]
    for k, (nx, ny) in enumerate(rest):
        last = k == len(rest) - 1
        top = ny - (5 if last else 0)
        middle = (y + top) / 2
        path.append(f"C{x:.1f} {middle:.1f} {nx:.1f} {middle:.1f} {nx:.1f} {top:.1f}")
        if not last:
            path.append(f"V{ny + ROOM_HEIGHT:.1f}")
        x, y = nx, ny + ROOM_HEIGHT
    dash = ' stroke-dasharray="5 4"' if dashed else ""
    return f'<path d="{" ".join(path)}" fill="none" stroke="{ink}" stroke-width="1.3"{dash} marker-end="url(#{ink[1:]})"/>'


def circle_arrow(low, high, ink):
    """An arrow up, dashed, beside the rooms: it closes a circle."""
    x, y = low[0] + ROOM_WIDTH / 4, low[1]
    nx, ny = high[0] + ROOM_WIDTH / 4, high[1] + ROOM_HEIGHT + 5
    return (f'<path d="M{x:.1f} {y:.1f} C{x:.1f} {(y + ny) / 2:.1f} {nx:.1f} {(y + ny) / 2:.1f} {nx:.1f} {ny:.1f}" fill="none" '
            f'stroke="{ink}" stroke-width="1.3" stroke-dasharray="5 4" marker-end="url(#{ink[1:]})"/>')


def room_box(top, room, place, caption):
    x, y = place[0] - ROOM_WIDTH / 2, place[1]
    name = f"{room}/" if room != "." else f"{top}/*.h"
    lines = lines_of(caption)
    out = [f'<rect x="{x:.1f}" y="{y:.1f}" width="{ROOM_WIDTH}" height="{ROOM_HEIGHT}" rx="6" fill="#ffffff" stroke="{INKS[top]}"/>',
           f'<text x="{place[0]:.1f}" y="{y + ((16 if len(lines) > 1 else 19) if lines else 27):.1f}" class="room" fill="{INKS[top]}">{html.escape(name)}</text>']
    for k, line in enumerate(lines):
        shift = 28.5 if len(lines) > 1 else 34
        out.append(f'<text x="{place[0]:.1f}" y="{y + shift + 11.5 * k:.1f}" class="caption">{html.escape(line)}</text>')
    return out


def folder_box(top, layout, texts, x, y, width, height):
    out = [f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" rx="10" fill="{FILLS[top]}" stroke="{INKS[top]}" '
           'stroke-opacity=".35"/>',
           f'<text x="{x + PADDING:.1f}" y="{y + 24:.1f}" class="folder" fill="{INKS[top]}">{top}/ '
           f'<tspan class="title">{TITLES[top]}</tspan></text>',
           f'<g transform="translate({x + (width - layout.width) / 2:.1f} {y + HEAD + PADDING / 2:.1f})">']
    for edge in sorted(layout.routes):
        out.append(arrow(layout.routes[edge], INKS[top]))
    for a, b in sorted(layout.circles):
        out.append(circle_arrow(layout.place[a], layout.place[b], INKS[top]))
    for room in layout.rooms:
        out += room_box(top, room, layout.place[room], texts.get((top, room), ""))
    return out + ["</g>"]


def thick_arrow(x, y, end):
    return f'<path d="M{x:.1f} {y:.1f} V{end - 9:.1f}" stroke="#777777" stroke-width="4" fill="none" marker-end="url(#thick)"/>'


def draw(graph, texts):
    layouts = {}
    for top in TOPS:
        rooms = [room for t, room in graph if t == top]
        layouts[top] = Layout(rooms, {room: {r for t, r in graph[top, room] if t == top} for room in rooms})
    title = {top: 9.5 * len(top) + 7.8 * len(TITLES[top]) for top in TOPS}
    box = {top: (max(layouts[top].width, title[top]) + 2 * PADDING, layouts[top].height + HEAD + 1.5 * PADDING) for top in TOPS}
    gap = 3 * PADDING  # between parallel and io: the arrow from apps to core passes there
    width = max(box["apps"][0], box["parallel"][0] + gap + box["io"][0], box["core"][0])
    spare = width - box["parallel"][0] - gap - box["io"][0]
    left, right = box["parallel"][0] + spare / 2, box["io"][0] + spare / 2
    second = box["apps"][1] + BETWEEN
    middle = max(box["parallel"][1], box["io"][1])
    third = second + middle + BETWEEN
    height = third + box["core"][1]
    out = []
    arrows = {(a[0], b[0]) for a, others in graph.items() for b in others if a[0] != b[0]}
    for (a, b), place in {("apps", "parallel"): (left / 2, box["apps"][1], second), ("apps", "io"): (left + gap + right / 2, box["apps"][1], second),
                          ("apps", "core"): (left + gap / 2, box["apps"][1], third), ("parallel", "core"): (left / 2, second + middle, third),
                          ("io", "core"): (left + gap + right / 2, second + middle, third)}.items():
        if (a, b) in arrows:
            out.append(thick_arrow(*place))
    out += folder_box("apps", layouts["apps"], texts, 0, 0, width, box["apps"][1])
    out += folder_box("parallel", layouts["parallel"], texts, 0, second, left, middle)
    out += folder_box("io", layouts["io"], texts, left + gap, second, right, middle)
    out += folder_box("core", layouts["core"], texts, 0, third, width, box["core"][1])
    return frame(out, width, height)


def frame(body, width, height):
    margin = 12
    marker = lambda name, ink, size: (
        f'<marker id="{name}" viewBox="0 0 8 8" refX="3" refY="4" markerWidth="{size}" markerHeight="{size}" orient="auto" '
        f'markerUnits="userSpaceOnUse"><path d="M0 0 L8 4 L0 8 Z" fill="{ink}"/></marker>')
    head = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{-margin} {-margin} {width + 2 * margin:.0f} {height + 2 * margin:.0f}" '
            f'width="{width + 2 * margin:.0f}" height="{height + 2 * margin:.0f}" font-family="Helvetica, Arial, \'Liberation Sans\', \'DejaVu Sans\', sans-serif">',
            f"<!-- Made by {COMMAND} from the #include lines and the READMEs: do not edit. -->",
            "<style>.folder{font-size:17px;font-weight:bold}.title{font-size:13px;font-weight:normal}"
            ".room{font-size:13px;font-weight:bold;text-anchor:middle}.caption{font-size:10px;text-anchor:middle;fill:#444444}</style>",
            "<defs>", *(marker(ink[1:], ink, 8) for ink in INKS.values()), marker("thick", "#777777", 18), "</defs>",
            f'<rect x="{-margin}" y="{-margin}" width="100%" height="100%" fill="#ffffff"/>']
    return "\n".join([*head, *body, "</svg>", ""])


def picture(root):
    return draw(include_graph(root), captions(root))


# ---------------------------------------------------------------------------------------------------------- checks


def unnamed_rooms(root):
    """Rooms that no row of their folder's README names, rows that name no room, and captions too long for their box."""
    graph, texts = include_graph(root), captions(root)
    for top, room in sorted(set(graph) - set(texts)):
        yield f"{top}/README.md: the table of rooms has no row for " + (f"`{room}/`" if room != "." else "the files of the folder (`*.h`)")
    for top, room in sorted(set(texts) - set(graph)):
        yield f"{top}/README.md: the table of rooms names {room}, which is not there"
    for (top, room), text in sorted(texts.items()):
        if len(lines_of(text)) > 2:
            yield f"{top}/README.md: {room}: what stands before the first colon does not fit two lines of {LETTERS} letters: {text}"


def outdated_picture(root):
    path = root / PICTURE
    if not path.is_file() or path.read_text() != picture(root):
        yield f"{PICTURE}: the folders, their includes or their READMEs have changed since it was drawn: run {COMMAND}"


if __name__ == "__main__":
    if sys.argv[1:]:
        sys.exit(__doc__)
    (ROOT / PICTURE).write_text(picture(ROOT))
    problems = list(unnamed_rooms(ROOT))
    print("\n".join([*problems, f"wrote {PICTURE}"]))
    sys.exit(1 if problems else 0)

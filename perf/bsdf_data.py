"""Synthetic BSDF files for benchmarks and tests: matrices over Klems' bases, tensor trees of rank 3 and 4, as documents.

A component is a function of two projected directions (x, y): where the light travels to before the system, and where it goes
behind it. Straight through is the same direction for both; its value is the BSDF [1/sr]. Documents are those of LBNL WINDOW
(its XML schema BSDF-v1.4.xsd); *Back* in them is the side of the surface's normal.
"""
import math

BASES = {  # upper polar angle [degrees] of each ring, number of its patches
    "LBNL/Klems Full": [(5, 1), (15, 8), (25, 16), (35, 20), (45, 24), (55, 24), (65, 24), (75, 16), (90, 12)],
    "LBNL/Klems Quarter": [(9, 1), (27, 8), (45, 12), (63, 12), (90, 8)],
}
FULL, QUARTER = BASES
TREE_BASIS = "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>"


def patches(basis=FULL):
    """Middle (x, y) and projected solid angle of each patch of a basis."""
    lower = 0
    for upper, count in BASES[basis]:
        omega = math.pi * (math.sin(math.radians(upper)) ** 2 - math.sin(math.radians(lower)) ** 2) / count
        r = 0 if count == 1 else math.sin(math.radians((lower + upper) / 2))
        for k in range(count):
            yield r * math.cos(2 * math.pi * k / count), r * math.sin(2 * math.pi * k / count), omega
        lower = upper


def document(structure, blocks):
    """@param blocks  (wavelength, direction, elements of the basis, text of the values)"""
    text = "".join(f"<WavelengthData><Wavelength>{wavelength}</Wavelength><WavelengthDataBlock><WavelengthDataDirection>{direction}"
                   f"</WavelengthDataDirection>{bases}<ScatteringData>\n{values}\n</ScatteringData></WavelengthDataBlock>"
                   "</WavelengthData>\n" for wavelength, direction, bases, values in blocks)
    return ('<?xml version="1.0"?>\n<WindowElement><FileType>BSDF</FileType><Optical><Layer><Material><Name>made</Name></Material>'
            f"<DataDefinition><IncidentDataStructure>{structure}</IncidentDataStructure></DataDefinition>\n{text}"
            "</Layer></Optical></WindowElement>\n")


def matrix_file(components, basis=FULL, through=0, wavelength="Visible"):
    """@param components  by direction ("Transmission Back", ..), a function of both directions
    @param through  the share that passes straight on, added to each diagonal of transmission"""
    table = list(patches(basis))
    bases = f"<ColumnAngleBasis>{basis}</ColumnAngleBasis><RowAngleBasis>{basis}</RowAngleBasis>"

    def matrix(direction, f):
        peak = through if direction.startswith("Transmission") else 0
        return ",\n".join(", ".join(f"{f(i[:2], o[:2]) + (peak / o[2] if i is o else 0):.5g}" for i in table) for o in table)
    return document("Columns", [(wavelength, d, bases, matrix(d, f)) for d, f in components.items()])


def disk(a, b):
    """The unit square to the unit disk with areas kept: Shirley and Chiu, Journal of Graphics Tools 2(3) (1997)."""
    a, b = 2 * a - 1, 2 * b - 1
    if abs(a) >= abs(b):
        return (a * math.cos(math.pi / 4 * b / a), a * math.sin(math.pi / 4 * b / a)) if a else (0, 0)
    return b * math.sin(math.pi / 4 * a / b), b * math.cos(math.pi / 4 * a / b)


def tree(rank, value, is_leaf):
    """The text of a tree.
    @param value    of a leaf by its lower corner and its size
    @param is_leaf  of corner, size and level; the whole is level 0"""
    def part(low, size, level):
        if is_leaf(low, size, level):
            return "{%.5g}" % value(low, size)
        half = size / 2  # bit i of a branch's number chooses the upper half of dimension i
        return "{" + " ".join(part([c + half * (n >> i & 1) for i, c in enumerate(low)], half, level + 1)
                              for n in range(1 << rank)) + "}\n"
    return part([0] * rank, 1, 0)


def tree4(f, levels, through=0, coarse=2):
    """Rank 4: leaves get smaller towards the directions that light passes straight in, where `through` passes."""
    def away(low, size):
        return max(abs(low[0] - low[2]), abs(low[1] - low[3]))

    def is_leaf(low, size, level):
        return level == levels or (level >= coarse and away(low, size) > 1.5 * size)

    def value(low, size):
        if through and size == 2 ** -levels and away(low, size) < size / 2:
            return through / (math.pi * size * size)
        middle = [c + size / 2 for c in low]
        return f(disk(*middle[:2]), disk(*middle[2:]))
    return tree(4, value, is_leaf)


def tree3(f, levels):
    """Rank 3, of isotropic systems: light travels towards +x; directions before the system have half of the first dimension."""
    def value(low, size):
        return f((1 - 2 * (low[0] + size / 2), 0), disk(low[1] + size / 2, low[2] + size / 2))
    return tree(3, value, lambda low, size, level: level == levels or (low[0] >= .5 and level))


def tree_file(rank, components):
    """@param components  by direction, the text of a tree"""
    return document(f"TensorTree{rank}", [("Visible", d, TREE_BASIS, text) for d, text in components.items()])


def gauss(height, width, x=0, y=0, base=0):
    """A lobe about the direction (dx, dy) beside straight through, or beside the mirrored one."""
    return lambda i, o: base + height * math.exp(-((o[0] - i[0] - x) ** 2 + (o[1] - i[1] - y) ** 2) / width)


def both(transmission, reflection):
    """Components of a system that is the same from both sides."""
    return {"Transmission Front": transmission, "Transmission Back": transmission,
            "Reflection Front": reflection, "Reflection Back": reflection}


def blind_file():
    """Light goes straight through between slats, and is scattered up and down by them."""
    table = list(patches())
    omega = {p[:2]: p[2] for p in table}

    def through(i, o):
        x, y = o[0] - i[0], abs(o[1]) - abs(i[1])
        straight = .3 / omega[o] if i == o and i[1] > -.3 else 0
        return .25 * math.exp(-(x * x + y * y) / .1) + .02 + straight

    def reflected(i, o):
        return .06 + .1 * math.exp(-((o[0] - i[0]) ** 2 + (o[1] + i[1]) ** 2) / .2)
    return matrix_file(both(through, reflected))


def pane_file(levels=5, width=.12):
    """A peak straight on with a haze about it."""
    return tree_file(4, both(tree4(gauss(.4, width, base=.012), levels, through=.55), "{.02}"))

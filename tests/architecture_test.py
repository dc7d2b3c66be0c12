#!/usr/bin/python3
"""The arrows of the design: apps -> parallel, io -> core, and inside core and io from folder to folder in one
order. core knows no threads, sockets, MPI or files. Also: types that share a name, test names that CTest can find, the READMEs' tables
of rooms, and whether the picture of the architecture is up to date.

    architecture_test.py              the project
    architecture_test.py --self-test  small planted trees: what must be found is found, and nothing else"""
import pathlib, re, sys, tempfile

sys.dont_write_bytecode = True  # the source tree stays as it is
import architecture_picture
from architecture_picture import INCLUDE, ROOT, ROW, sources, subfolder

FORBIDDEN_FOLDERS = {"core": {"io", "parallel", "apps"}, "io": {"parallel", "apps"}, "parallel": {"io", "apps"}, "apps": set()}
FORBIDDEN_HEADERS = {
    "core": r"<(thread|mutex|shared_mutex|condition_variable|future|fstream|iostream|filesystem|mpi\.h|tbb/.*|oneapi/.*|boost/.*|sys/.*)>",
    "io": r"<(thread|mpi\.h|tbb/.*|oneapi/.*)>",
    "parallel": r"<(fstream|filesystem)>",
    "apps": r"(?!)",
}
# Folders from the lowest to the highest: a file may include files of its own folder and of those before it.
# "." are the files that lie in no subfolder; None: not held yet.
ORDER = {
    "core": [".", "math", "spectrum", "bsdf", "model", "view", "glare", "function", "geometry", "scene", "plan", "transport", "texture", "light", "virtual_source", "material", "ambient", "batch", "trace", "cloud"],
    "parallel": ["comm", "fibers", ".", "walk", "work_queue", "ranks"],
    "io": ["files", "formats", "photometry", "options", "picture", "openimageio", "ambient", "rays", "contributions", "language", "wavefront", "gltf", "bsdf", "generators", "scene", "rad", "net"],
}

def wrong_includes(root):
    for folder, forbidden in FORBIDDEN_FOLDERS.items():
        for path in sources(root / folder):
            for kind, name in INCLUDE.findall(path.read_text()):
                if name.split("/")[0] in forbidden or (kind == "<" and re.match(FORBIDDEN_HEADERS[folder], f"<{name}>")):
                    yield f"{path.relative_to(root)}: includes {name}"


def wrong_order(root, order):
    """Includes that point to a higher folder: without them there is no circle of folders."""
    for top, folders in order.items():
        if folders is None:
            continue
        rank = {folder: k for k, folder in enumerate(folders)}
        found = set()
        for path in sources(root / top):
            name = str(path.relative_to(root))
            own = subfolder(name)
            found.add(own)
            if own not in rank:
                yield f"{name}: {top}'s folder {own} is not in the order of folders"
                continue
            for kind, included in INCLUDE.findall(path.read_text()):
                if included.split("/")[0] != top:
                    continue
                other = subfolder(included)
                if other not in rank:
                    yield f"{name}: includes {included}, whose folder is not in the order of folders"
                elif rank[other] > rank[own]:
                    yield f"{name}: includes {included}, {other} stands above {own}"
        for folder in folders:
            if folder not in found:
                yield f"{top}: the order names the folder {folder}, which has no sources"


def unsorted_rooms(root, order):
    """The table of rooms in a folder's README is in the order of its rooms. Rooms without sources may stand anywhere."""
    for top, folders in order.items():
        readme = root / top / "README.md"
        if folders is None or not readme.is_file():
            continue
        rooms = ["." if name.startswith("*") else name.strip("/") for name, _ in ROW.findall(readme.read_text())]
        if [room for room in rooms if room in folders] != folders:
            yield f"{top}/README.md: the rows of its table of rooms are not in the order of folders: {', '.join(folders)}"


NAMESPACE = re.compile(r"^namespace ([\w:]+) \{", re.M)
TYPE = re.compile(r"^(?:struct|class|union|enum|enum class) (?:\[\[\w+\]\] |alignas\([^)]*\) )?(\w+)(?: final)?(?: : [^{;]*)? \{", re.M)


def shared_names(root):
    """Two types of one name break the one-definition rule: the linker keeps one of their members, for both.
    Compilers need not find it, and where calls are inlined it does no harm, until a build inlines less."""
    places = {}
    for path in sorted(p for top in (*FORBIDDEN_FOLDERS, "perf", "tests") for p in sources(root / top)):
        text = re.sub(r"^namespace \{$.*?^\}  // namespace$", "", path.read_text(), flags=re.M | re.S)
        space = NAMESPACE.search(text)
        for name in TYPE.findall(text):
            places.setdefault((space and space[1], name), []).append(str(path.relative_to(root)))
    for (_, name), paths in sorted(places.items(), key=lambda place: place[1]):
        if len(paths) > 1:
            yield f"{paths[-1]}: a type named {name} is also in {paths[0]}"


def lost_tests(root):
    """CMake would cut such names apart, and CTest would run none of the pieces."""
    for path in sorted((root / "tests").rglob("*_test.cpp")):
        for name in re.findall(r'TEST_CASE\(\s*"((?:[^"\\]|\\.)*)"', path.read_text()):
            if re.search(r"[;\[\]\\]", name):
                yield f"{path.relative_to(root)}: test name with ; [ ] or \\: {name}"


def check_project():
    files = [p for f in FORBIDDEN_FOLDERS for p in (ROOT / f).rglob("*.h")]
    embree = [p for f in FORBIDDEN_FOLDERS for p in (ROOT / f).rglob("*.[hc]*") if "embree3/" in p.read_text()]
    problems = [*wrong_includes(ROOT), *wrong_order(ROOT, ORDER), *unsorted_rooms(ROOT, ORDER), *shared_names(ROOT), *lost_tests(ROOT),
                *architecture_picture.unnamed_rooms(ROOT), *architecture_picture.outdated_picture(ROOT)]
    if len(files) < 20:
        problems.append("the headers were not found: is this the project's root?")
    if len(embree) != 1:
        problems.append("Embree is included by: " + ", ".join(str(p.relative_to(ROOT)) for p in embree))
    print("\n".join(problems) or f"{len(files)} headers, arrows point down")
    return 1 if problems else 0


# A small tree that is right: low is below high, and beside them lies a file of the root.
SOUND = {
    "io/base.h": "#include <string>\n",
    "io/low/low.h": '#include "io/base.h"\n',
    "io/low/low.cpp": '#include "io/low/low.h"\n',
    "io/high/high.cpp": '#include "core/any/where.h"\n#include "io/low/low.h"\n',
    "io/README.md": "| `*.h` | all |\n| `low/` | the low: much |\n| `data/` | none |\n| `high/` | the high |\n",
    "tests/sound_test.cpp": 'TEST_CASE("a name") {}\n',
}
SOUND_ORDER = {"core": None, "io": [".", "low", "high"]}
# What is planted in it, and the one problem that must be found.
PLANTED = [
    ({}, None),
    # low includes high, which includes low: a circle.
    ({"io/low/low.cpp": '#include "io/high/high.h"\n'}, "io/low/low.cpp: includes io/high/high.h, high stands above low"),
    ({"io/low/low.h": '#  include "io/high/high.h"\n'}, "io/low/low.h: includes io/high/high.h, high stands above low"),
    ({"io/low/deep/er.h": '#include "io/high/high.h"\n'}, "io/low/deep/er.h: includes io/high/high.h, high stands above low"),
    ({"io/base.h": '#include "io/low/low.h"\n'}, "io/base.h: includes io/low/low.h, low stands above ."),
    ({"io/new/new.h": ""}, "io/new/new.h: io's folder new is not in the order of folders"),
    ({"io/low/low.h": '#include "io/gone/gone.h"\n'}, "io/low/low.h: includes io/gone/gone.h, whose folder is not in the order of folders"),
    ({"io/high/high.cpp": None}, "io: the order names the folder high, which has no sources"),
    ({"io/README.md": "| `*.h` | all |\n| `high/` | the high |\n| `low/` | the low: much |\n"},
     "io/README.md: the rows of its table of rooms are not in the order of folders: ., low, high"),
    ({"io/README.md": "| `low/` | the low: much |\n| `high/` | the high |\n"},
     "io/README.md: the rows of its table of rooms are not in the order of folders: ., low, high"),
    ({"io/low/low.cpp": '#include "parallel/blocks.h"\n'}, "io/low/low.cpp: includes parallel/blocks.h"),
    ({"io/low/low.cpp": "#include <thread>\n"}, "io/low/low.cpp: includes thread"),
    ({"core/any/a.h": '#include "io/base.h"\n'}, "core/any/a.h: includes io/base.h"),
    ({"io/low/low.cpp": "namespace a {\nstruct Piece {\n};\n}\n", "core/any/a.h": "namespace a {\nstruct Piece : Base {\n};\n}\n"},
     "io/low/low.cpp: a type named Piece is also in core/any/a.h"),
    ({"io/low/low.cpp": "namespace a {\nnamespace {\nstruct Piece {\n};\n}  // namespace\n}\n", "core/any/a.h": "namespace a {\nstruct Piece {\n};\n}\n"},
     None),
    ({"tests/sound_test.cpp": 'TEST_CASE("a; b") {}\n'}, "tests/sound_test.cpp: test name with ; [ ] or \\: a; b"),
]


# What is planted in it, and what the check of its picture and tables must find once the picture is that of SOUND and PICTURED.
PICTURED = {"io/data/table.txt": "1\n", "io/high/more.h": '#include "io/base.h"\n'}
OUTDATED = ("core/architecture.svg: the folders, their includes or their READMEs have changed since it was drawn: "
            "run tests/architecture_picture.py")
PICTURE_PLANTED = [
    ({}, []),
    # high includes base, as it does already; it would follow anyway, since high includes low, which includes base.
    ({"io/high/more.h": ""}, []),
    ({"io/low/low.h": ""}, [OUTDATED]),
    ({"io/low/low.h": '#include "io/base.h"\n#include "io/high/more.h"\n'}, [OUTDATED]),  # a circle is drawn, too
    ({"io/high/high.cpp": '#include "core/any/where.h"\n'}, [OUTDATED]),
    ({"io/new/new.h": ""}, ["io/README.md: the table of rooms has no row for `new/`", OUTDATED]),
    ({"io/data/table.txt": None}, ["io/README.md: the table of rooms names data, which is not there", OUTDATED]),
    ({"io/README.md": SOUND["io/README.md"].replace("much", "little")}, []),
    ({"io/README.md": SOUND["io/README.md"].replace("the low", "the lowest")}, [OUTDATED]),
]


def plant(root, files):
    for name, text in files.items():
        if text is not None:
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)


def self_test_picture():
    failures = 0
    for planted, expected in PICTURE_PLANTED:
        with tempfile.TemporaryDirectory() as drawn, tempfile.TemporaryDirectory() as folder:
            plant(pathlib.Path(drawn), SOUND | PICTURED)
            root = pathlib.Path(folder)
            plant(root, SOUND | PICTURED | planted | {"core/architecture.svg": architecture_picture.picture(pathlib.Path(drawn))})
            found = [*architecture_picture.unnamed_rooms(root), *architecture_picture.outdated_picture(root)]
        if found != expected:
            failures += 1
            print(f"planted {planted}:\n  found {found}\n  expected {expected}")
    return failures


def self_test():
    failures = self_test_picture()
    for planted, expected in PLANTED:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            plant(root, SOUND | planted)
            found = [*wrong_includes(root), *wrong_order(root, SOUND_ORDER), *unsorted_rooms(root, SOUND_ORDER), *shared_names(root),
                     *lost_tests(root)]
        if found != ([] if expected is None else [expected]):
            failures += 1
            print(f"planted {planted}:\n  found {found}\n  expected {expected}")
    print(f"{len(PLANTED) + len(PICTURE_PLANTED)} trees, {failures} failures")
    return 1 if failures else 0


sys.exit(self_test() if sys.argv[1:] == ["--self-test"] else check_project())

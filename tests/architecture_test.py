#!/usr/bin/python3
"""The arrows of the design: apps -> parallel, io -> core. core knows no threads, sockets, MPI or files.
Also: test names that CTest can find."""
import pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FORBIDDEN_FOLDERS = {"core": {"io", "parallel", "apps"}, "io": {"parallel", "apps"}, "parallel": {"io", "apps"}, "apps": set()}
FORBIDDEN_HEADERS = {
    "core": r"<(thread|mutex|shared_mutex|condition_variable|future|fstream|iostream|filesystem|mpi\.h|tbb/.*|oneapi/.*|boost/.*|sys/.*)>",
    "io": r"<(thread|mpi\.h|tbb/.*|oneapi/.*)>",
    "parallel": r"<(fstream|filesystem)>",
    "apps": r"(?!)",
}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)


def wrong_includes():
    for folder, forbidden in FORBIDDEN_FOLDERS.items():
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            for kind, name in INCLUDE.findall(path.read_text()):
                if name.split("/")[0] in forbidden or (kind == "<" and re.match(FORBIDDEN_HEADERS[folder], f"<{name}>")):
                    yield f"{path.relative_to(ROOT)}: includes {name}"


def lost_tests():
    """CMake would cut such names apart, and CTest would run none of the pieces."""
    for path in sorted((ROOT / "tests").rglob("*_test.cpp")):
        for name in re.findall(r'TEST_CASE\(\s*"((?:[^"\\]|\\.)*)"', path.read_text()):
            if re.search(r"[;\[\]\\]", name):
                yield f"{path.relative_to(ROOT)}: test name with ; [ ] or \\: {name}"


def main():
    files = [p for f in FORBIDDEN_FOLDERS for p in (ROOT / f).rglob("*.h")]
    embree = [p for f in FORBIDDEN_FOLDERS for p in (ROOT / f).rglob("*.[hc]*") if "embree3/" in p.read_text()]
    problems = [*wrong_includes(), *lost_tests()]
    if len(files) < 20:
        problems.append("the headers were not found: is this the project's root?")
    if len(embree) != 1:
        problems.append("Embree is included by: " + ", ".join(str(p.relative_to(ROOT)) for p in embree))
    print("\n".join(problems) or f"{len(files)} headers, arrows point down")
    return 1 if problems else 0


sys.exit(main())

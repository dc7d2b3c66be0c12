#!/usr/bin/python3
"""Tests of the Python package as users have it, installed from a wheel. Exit status 77: skipped, as something is not installed.

    run_tests.py wheel CMAKE BUILD_FOLDER FOLDER   makes a wheel of what is built, and an environment in FOLDER with it
    run_tests.py FOLDER TEST.py ...                runs tests in that environment

What is built is not compiled again: the wheel is what the install component "python" holds, with the metadata of pyproject.toml."""
import base64, csv, hashlib, importlib.util, io, os, pathlib, shutil, subprocess, sys, sysconfig, venv, zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROJECT = ROOT / "apps/python"
SKIPPED = 77


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def metadata():
    """The files of a wheel's folder NAME-VERSION.dist-info. See "Binary distribution format" (packaging.python.org)."""
    import tomllib
    project = tomllib.loads((PROJECT / "pyproject.toml").read_text())["project"]
    tag = "cp{0}{1}-cp{0}{1}-{2}".format(*sys.version_info[:2], sysconfig.get_platform().replace("-", "_").replace(".", "_"))
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {project['version']}", f"Summary: {project['description']}",
             f"Requires-Python: {project['requires-python']}", *(f"Requires-Dist: {name}" for name in project["dependencies"])]
    scripts = "\n".join(f"{name} = {call}" for name, call in project["scripts"].items())
    return f"{project['name']}-{project['version']}", tag, {
        "METADATA": "\n".join(lines) + "\n\n" + (PROJECT / project["readme"]).read_text(),
        "WHEEL": f"Wheel-Version: 1.0\nGenerator: lightwalk\nRoot-Is-Purelib: false\nTag: {tag}\n",
        "entry_points.txt": f"[console_scripts]\n{scripts}\n"}


def write_wheel(package, folder):
    name, tag, texts = metadata()
    wheel = folder / f"{name}-{tag}.whl"
    record = io.StringIO()
    rows = csv.writer(record, lineterminator="\n")
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for path in sorted(path for path in package.rglob("*") if path.is_file()):
            add(archive, rows, str(path.relative_to(package)), path.read_bytes(), path.stat().st_mode)
        for file, text in texts.items():
            add(archive, rows, f"{name}.dist-info/{file}", text.encode(), 0o100644)
        rows.writerow([f"{name}.dist-info/RECORD", "", ""])
        archive.writestr(f"{name}.dist-info/RECORD", record.getvalue())
    return wheel


def add(archive, rows, name, data, mode):
    entry = zipfile.ZipInfo(name)
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.external_attr = mode << 16
    archive.writestr(entry, data)
    rows.writerow([name, "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode(), len(data)])


def make_environment(cmake, build, folder):
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([cmake, "--install", build, "--component", "python", "--prefix", folder / "package"], check=True, stdout=subprocess.DEVNULL)
    wheel = write_wheel(folder / "package", folder)
    venv.create(folder / "environment", system_site_packages=True, with_pip=False, symlinks=True)
    python = folder / "environment/bin/python"
    subprocess.run([sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-index", "--no-deps", "--ignore-installed", wheel], check=True)
    shown = subprocess.run([folder / "environment/bin/lightwalk", "--version"], check=True, capture_output=True, text=True).stdout
    print(f"{wheel.name}, {wheel.stat().st_size >> 20} MB, is installed; its program is {shown.strip()}")


def main(first, *words):
    if first == "none":
        skip("the package is not built, which takes pybind11-dev and python3-dev")
    missing = [name for name in ("numpy", "pytest", "pip") if importlib.util.find_spec(name) is None]
    if missing:
        skip("not installed: " + ", ".join(missing))
    if first == "wheel":
        return make_environment(*words)
    tests = [ROOT / "tests/python" / name for name in words]
    environment = dict(os.environ)
    if "LIGHTWALK_PRELOAD" in environment:  # of a sanitizer, which finds what the interpreter keeps to its end
        environment["LD_PRELOAD"] = environment["LIGHTWALK_PRELOAD"]
        for name, options in (("ASAN_OPTIONS", ":detect_leaks=0:allocator_may_return_null=1"), ("TSAN_OPTIONS", " allocator_may_return_null=1")):
            environment[name] = environment.get(name, "") + options  # Python is told of what is too large, too
    done = subprocess.run([pathlib.Path(first) / "environment/bin/python", "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--durations=5", *tests],
                          cwd=first, env=environment)
    sys.exit(done.returncode)


main(*sys.argv[1:])

#!/usr/bin/python3
"""Makes the Debian packages of what is built, and looks at what they hold and ask for: debian_test.py CPACK BUILD_FOLDER

Where lintian is installed it must find no error. The packages are also unpacked side by side, without installing them, and the
program, the Python package and the manual pages used from there."""
import fnmatch, os, pathlib, shutil, subprocess, sys, tempfile

SKIPPED = 77
SCENE = "void glow even 0 0 4 1 1 1 0\neven source sky 0 0 4 0 0 1 360\n"
# Package: files that it must hold (* is any folders, too), and others' names in what it depends on.
PACKAGES = {
    "lightwalk": (["usr/bin/lightwalk", "usr/bin/lightwalk-served", "usr/share/man/man1/lightwalk.1.gz", "usr/share/man/man1/lightwalk-render.1.gz"], ["lightwalk-data", "liblightwalk0.1", "libtbb12"]),
    "lightwalk-data": (["usr/share/lightwalk/lib/*.cal", "usr/share/lightwalk/scenes/lodge/lodge.rad"], []),
    "liblightwalk0.1": (["usr/lib/*liblightwalk.so.0.1", "usr/lib/*lightwalk/liblightwalk_openimageio.so"], ["libc6", "libembree3-3", "libopenimageio"]),
    "lightwalk-mpi": (["usr/lib/*lightwalk/liblightwalk_mpi.so"], ["libopenmpi3", "openmpi-bin"]),
    "liblightwalk-dev": (["usr/include/lightwalk/scene.h", "usr/lib/*liblightwalk.a", "usr/lib/*liblightwalk.so"], ["liblightwalk0.1"]),
    "python3-lightwalk": (["usr/lib/python3/dist-packages/lightwalk/__init__.py", "usr/lib/python3/dist-packages/lightwalk/bin/_core*.so"], ["python3-numpy", "lightwalk"]),
}


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit status {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def main(cpack, build):
    if not all(map(shutil.which, ("dpkg-deb", "dpkg-shlibdeps", "file"))):
        print("skipped: dpkg-dev or file is not installed")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        # Packed as fast as can be: how small the packages become is not what is tested.
        run(cpack, "-G", "DEB", "--config", pathlib.Path(build) / "CPackConfig.cmake", "-B", folder / "made",
            "-D", f"CPACK_OUTPUT_FILE_PREFIX={folder / 'packages'}", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")
        files = {path.name.split("_")[0]: path for path in sorted((folder / "packages").rglob("*.deb"))}
        missing = PACKAGES.keys() - files.keys() - {"python3-lightwalk"}  # which is built where pybind11 is
        assert not missing, f"not made: {missing}"
        root = folder / "root"
        held = {}
        for name, path in files.items():
            run("dpkg-deb", "-x", path, folder / name)
            for file in (folder / name).rglob("*"):
                if not file.is_dir() or file.is_symlink():
                    assert held.setdefault(file.relative_to(folder / name), name) == name, f"{file}: in two packages"
            for pattern in [*PACKAGES[name][0], f"usr/share/doc/{name}/copyright", f"usr/share/doc/{name}/changelog.gz"]:
                assert any(fnmatch.fnmatch(str(file), pattern) for file, package in held.items() if package == name), f"{name}: no {pattern}"
            depends = run("dpkg-deb", "-f", path, "Depends")
            for other in PACKAGES[name][1]:
                assert other in depends, f"{name} does not depend on {other}: {depends}"
            run("dpkg-deb", "-x", path, root)
        pages = {path.name for path in (root / "usr/share/man/man1").iterdir()}
        for command in run(root / "usr/bin/lightwalk", "help").splitlines():
            words = command.split()
            if command.startswith("  lightwalk ") and words[1].islower() and words[1] != "help" and not words[2:3] == ["-vp"]:
                assert f"lightwalk-{words[1]}.1.gz" in pages, f"no page of {words[1]}"
        use(root, folder)
        if shutil.which("lintian"):
            found = subprocess.run(["lintian", "--fail-on=error", "--allow-root", *map(str, files.values())], capture_output=True, text=True)
            assert found.returncode == 0, found.stdout
        print(f"{len(files)} packages" + ("" if shutil.which("lintian") else "; lintian is not installed"))
    return 0


def use(root, folder):
    """The program finds its modules and its library where it lies; so does the Python package."""
    (folder / "sky.rad").write_text(SCENE)
    clean = {name: value for name, value in os.environ.items() if name != "RAYPATH"}
    run(root / "usr/bin/lightwalk", "render", "-x", "8", "-y", "8", "-o", folder / "sky.png", folder / "sky.rad", env=clean)
    assert (folder / "sky.png").read_bytes().startswith(b"\x89PNG")
    if (root / "usr/lib/python3/dist-packages").is_dir():
        code = ("import lightwalk, sys; scene = lightwalk.demo_scene(); "
                "lightwalk.save_picture(sys.argv[1], scene.render(lightwalk.demo_views()['living'], 8)); print(lightwalk.__file__)")
        used = run("/usr/bin/python3", "-c", code, folder / "room.png", env=clean | {"PYTHONPATH": str(root / "usr/lib/python3/dist-packages")})
        assert used.startswith(str(root)), used
        assert (folder / "room.png").read_bytes().startswith(b"\x89PNG")


sys.exit(main(*sys.argv[1:]))

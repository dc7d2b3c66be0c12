"""lightwalk.pyradiance: pyradiance's functions run the same command lines, and the values beside them are the same."""

import copy
import datetime
import importlib.util
import inspect
import os
import pathlib
import pickle
import random
import shlex
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np
import pytest

import lightwalk
import lightwalk.pyradiance as pr
from lightwalk.pyradiance import _absent, _programs, _render
from pyradiance_cases import CALLS, SIGNATURES

SUITE = os.environ.get("LIGHTWALK_PYRADIANCE_TESTS", "")  # a folder with pyradiance's own tests
OCTREE = b"#?RADIANCE\nFORMAT=Radiance_octree\n\n\x01\x1f-1\x00-1\x00-1\x008\x00\x00"
DEFAULT_VIEW = ("-vtv -vp 0.000000 0.000000 0.000000 -vd 0.000000 1.000000 0.000000 -vu 0.000000 0.000000 1.000000 -vh 45.000000 -vv 45.000000 "
                "-vs 0.000000 -vl 0.000000 -vo 0.000000 -va 0.000000")


class Recorder:
    """Stands for subprocess.run: keeps what would be run, and answers for it."""

    def __init__(self, answers=None):
        self.calls = []
        self.answers = answers or {}
        self.run = subprocess.run

    def __call__(self, words, **options):
        if os.fspath(words[0]) == os.fspath(_programs.PROGRAM):  # the program under its own name
            return self.run(words, **options)
        name = os.path.basename(words[0])
        self.calls.append(([name, *map(str, words[1:])], options.get("input")))
        return subprocess.CompletedProcess(words, 0, self.answers.get(name, b""), b"")


@pytest.fixture
def recorder(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    pathlib.Path("a.hdr").write_bytes(b"bytes")
    stand_in = Recorder()
    monkeypatch.setattr(subprocess, "run", stand_in)
    return stand_in


@pytest.fixture
def by_name():
    """Skips where the program does not act by the name that it is called by."""
    done = subprocess.run(["rtrace", "-version"], executable=_programs.PROGRAM, stdin=subprocess.DEVNULL, capture_output=True, check=False)
    if not done.stdout.startswith(b"RADIANCE"):
        pytest.skip("the program does not act by Radiance's names")


def signature(function):
    marks = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    return ", ".join(marks.get(one.kind, "") + one.name + ("" if one.default is one.empty else f"={one.default!r}")
                     for one in inspect.signature(function).parameters.values())


def found(module, name):
    for part in name.split("."):
        module = getattr(module, part)
    return module


def names_of(module):
    return {name: getattr(module, name) for name in pr.__all__ if hasattr(module, name)} | {
        "P": pathlib.Path, "D": datetime.datetime(2022, 2, 1, 12, 30, 45), "__builtins__": {}}


@pytest.mark.parametrize("name", SIGNATURES)
def test_functions_have_pyradiances_signatures(name):
    assert signature(found(pr, name)) == SIGNATURES[name]


@pytest.mark.parametrize("call", CALLS, ids=lambda call: call[0][:60])
def test_a_call_runs_pyradiances_command_line(recorder, call):
    text, line, *stdin = call
    eval(text, names_of(pr))
    assert recorder.calls == [(shlex.split(line), stdin[0] if stdin else None)]


def test_the_expected_command_lines_are_those_of_pyradiance_where_it_is_installed(recorder):
    if importlib.util.find_spec("pyradiance") is None:
        pytest.skip("pyradiance is not installed")
    import pyradiance
    for name, expected in SIGNATURES.items():
        assert signature(found(pyradiance, name)) == expected
    for text, line, *stdin in CALLS:
        recorder.calls.clear()
        eval(text, names_of(pyradiance))
        assert recorder.calls == [(shlex.split(line), stdin[0] if stdin else None)]


def test_where_pyradiance_loses_arguments_they_count(recorder):
    pr.rtrace(b"", "a.oct", trace_exclude="red green")
    pr.Rcontrib(b"", "a.oct", inform="f").add_modifier("m")()
    pr.Rcontrib(b"", "a.oct", outform="f").add_modifier("m")()
    assert [shlex.join(words) for words, _ in recorder.calls] == [
        "rtrace -faa -te red -te green a.oct", "rcontrib -n 1 -ffa -m m a.oct", "rcontrib -n 1 -faf -m m a.oct"]


@pytest.mark.parametrize(("call", "kind"), [
    ("gensky(altitude=3)", ValueError), ("gendaylit()", ValueError), ("genprism('m', 'n')", ValueError), ("genprism('m', 'n', [0, 0, 1, 0, 1])", ValueError),
    ("genprism('m', 'n', [0, 0, 1, 0])", ValueError), ("genprism('m', 'n', [0] * 6, vfile='v')", ValueError), ("vwrays()", ValueError),
    ("genprism('m', 'n', [0] * 6, lvect=(1, 2))", ValueError), ("falsecolor('a.hdr', contour='x')", ValueError), ("gensky('noon')", TypeError),
    ("getinfo('a.hdr', 'b', strip_header=True)", ValueError), ("parse_primitive(5)", TypeError), ("genbox('m', 'n', 1, 2, [3])", TypeError),
    ("getinfo('a.hdr', b'')", TypeError), ("get_header(5)", TypeError), ("get_image_dimensions('a.hdr')", ValueError), ("evalglare(5)", TypeError),
    ("pvalue(5)", TypeError),
    ("oconv(stdin='text')", TypeError), ("oconv(b'scene')", TypeError), ("rtrace('text', 'a.oct')", TypeError), ("rtrace(b'', b'octree')", TypeError),
    ("rpict('-vf v.vf', 'a.oct')", TypeError), ("rpict([], 'a.oct', params='-ab 2')", TypeError), ("Rcontrib('text', 'a.oct')()", TypeError),
    ("Rcontrib(b'', 'a.oct').add_modifier()", ValueError), ("Rcontrib(b'', 'a.oct').add_modifier('m', 'file')", ValueError), ("Xform(5)()", TypeError),
    ("Scene('')", ValueError), ("Scene('s', wrong=[])", TypeError), ("Scene('s').build(1)", TypeError), ("View().other", AttributeError),
    ("parse_view('-vp 1 2')", ValueError), ("parse_view('-vh x')", ValueError), ("parse_view('-vtx')", ValueError), ("parse_view(5)", TypeError),
    ("viewfile('none.vf')", RuntimeError), ("viewfile('a.hdr')", RuntimeError), ("set_option(['-ab'])", TypeError), ("set_option(['-zz', '2'])", TypeError),
    ("set_option('-ab 2')", TypeError), ("set_ray_params(5)", TypeError), ("get_view_args(5)", TypeError), ("get_ray_params_args(5)", TypeError),
    ("write('a.hdr', b'', overwrite=False)", FileExistsError), ("write('b', 'text')", TypeError), ("write('none/b', b'')", OSError),
    ("render(Scene('s'))", ValueError), ("parse_primitive('void plastic')", ValueError), ("parse_primitive('void plastic p 0 0 x')", ValueError)])
def test_what_is_wrong_is_an_exception(recorder, call, kind):
    with pytest.raises(kind):
        eval(call, names_of(pr))
    assert not os.path.exists("b")


def test_any_values_are_taken_or_refused(recorder):
    values = (None, True, 0, -1.5, 1 << 70, float("nan"), "", "a b", "\0", b"\xff", [], ["x", 1], (1, 2, 3), {}, object(), pathlib.Path("p"), pr.View(), int,
              datetime.datetime.max, np.zeros(3), np.float32(2), np.array(["x"]))
    functions = [getattr(pr, name) for name in pr.__all__ if name not in ("Scene", "render", "write") and not name.startswith(("set_", "ray_"))
                 and not (isinstance(getattr(pr, name), type) and issubclass(getattr(pr, name), Exception))]
    dice = random.Random(1)
    for _ in range(5000):
        function = dice.choice(functions)
        names = list(inspect.signature(function).parameters)
        try:
            result = function(*dice.choices(values, k=dice.randint(0, 3)), **{name: dice.choice(values) for name in names[3:] if dice.random() < .3})
            if callable(result):
                result()
        except (TypeError, ValueError, OSError, lightwalk.Error):
            pass


def test_a_program_that_fails_is_an_exception_with_its_message(monkeypatch, tmp_path):
    program = tmp_path / "program"
    program.write_text('#!/bin/sh\necho "$0 $*" >&2\n[ "$1" = - ] || exit 3\n')
    program.chmod(0o755)
    monkeypatch.setattr(_programs, "executable", lambda name: str(program))
    with pytest.raises(pr.ProgramError, match="^An error occurred with exit code 3: .* -w a.rad\n$") as caught:
        pr.oconv("a.rad", warning=False)
    assert isinstance(caught.value, RuntimeError) and isinstance(caught.value, lightwalk.Error)
    assert (caught.value.program, caught.value.returncode) == ("oconv", 3) and "-w a.rad" in caught.value.stderr
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    with pytest.warns(lightwalk.LightwalkWarning, match=" -$"):
        assert pr.oconv(stdin=b"void") == b""
    with pytest.raises(lightwalk.InputError, match="null byte"):
        pr.oconv("a\0.rad")
    monkeypatch.setattr(_programs, "executable", lambda name: str(tmp_path / "none"))
    with pytest.raises(lightwalk.Error, match="oconv: cannot be run"):
        pr.oconv("a.rad")


def test_names_that_are_not_covered_say_what_to_use():
    for name in _absent.ABSENT:
        assert not hasattr(pr, name)
        with pytest.raises(pr.NotCovered, match=f"has no {name}: .{{10}}"):
            getattr(pr, name)
    with pytest.raises(AttributeError, match="no attribute 'opens'$"):
        pr.opens
    if importlib.util.find_spec("pyradiance") is not None:
        import pyradiance
        public = {name for name in dir(pyradiance) if not name.startswith("_")} - {"os", "pathlib", "version"}
        assert public - set(_absent.ABSENT) <= set(dir(pr))


def test_a_view_is_what_its_words_tell():
    view = pr.create_default_view()
    assert shlex.join(pr.get_view_args(view)) == DEFAULT_VIEW == shlex.join(pr.get_view_args(pr.View())) == shlex.join(pr.get_view_args(pr.parse_view("")))
    view.type, view.vp, view.hoff = "l", [1, 2.5, 1 / 3], 1e-3
    assert (view.type, view.vp, view.hoff, view.vdir) == ("l", (1, 2.5, 1 / 3), 1e-3, (0, 1, 0))
    other = pickle.loads(pickle.dumps(copy.copy(view)))
    other.vp = (0, 0, 1)
    assert (other.type, other.hoff, view.vp) == ("l", 1e-3, (1, 2.5, 1 / 3))
    assert repr(view) == " -vtl -vp 1 2.5 0.333333 -vd 0 1 0 -vu 0 0 1 -vh 45 -vv 45 -vo 0 -va 0 -vs 0.001 -vl 0"
    parsed = pr.parse_view("VIEW= -vtl -vp 1 2.5 .3 -x 100 -vd 0 0 -1 -vu 0 1 0 -vh 30 -vv 20 -vs .1 -vl .2 -vo 1 -va 9")
    assert [getattr(parsed, name) for name in parsed.__dir__()] == ["l", (1, 2.5, .3), (0, 0, -1), (0, 1, 0), 30, 20, .1, .2, 1, 9]
    for name, value, kind in (("type", "x", ValueError), ("type", "ab", TypeError), ("vp", (1, 2), TypeError), ("vp", "123", TypeError), ("vp", 1, TypeError),
                              ("horiz", "1", TypeError), ("horiz", float("nan"), ValueError), ("vdir", (0, 0, float("inf")), ValueError),
                              ("eye", 1, AttributeError)):
        with pytest.raises(kind, match=name):
            setattr(view, name, value)


def test_a_view_file_tells_a_view_line_by_line(tmp_path):
    file = tmp_path / "v.vf"
    file.write_text("rvu -vtv -vp 1 2 3\nVIEW= -vh 60\n")
    assert (pr.viewfile(file).vp, pr.viewfile(str(file)).horiz) == ((1, 2, 3), 60)
    file.write_bytes(b"#?RADIANCE\nrpict -vp 4 5 6\nVIEW= -vta -vp 1 2 3\n\n-Y 1 +X 1\n\xff VIEW= -vp 9 9 9\n")
    assert (pr.viewfile(file).vp, pr.viewfile(file).type) == ((1, 2, 3), "a")


def test_ray_parameters_are_values():
    params = pr.get_default_ray_params()
    words = pr.get_ray_params_args(params)
    assert shlex.join(words) == ("-u+ -bv -dt 0.030000 -dc 0.750000 -dj 0.000000 -dr 2 -dp 512 -dv -ds 0.200000 -st 0.150000 -ss 1.000000 -lr -10 -lw 0.000100 "
                                 "-av 0.000000 0.000000 0.000000 -aw 0 -aa 0.100000 -ar 256 -ad 1024 -as 512 -ab 0 -me 0.000000 0.000000 0.000000 "
                                 "-ma 0.000000 0.000000 0.000000 -mg 0.000000 -ms 0.000000")
    params.u, params.dv, params.i, params.av, params.as_, params.af, params.ambincl, params.amblist = False, False, True, (1, 2, 3), 7, "f.amb", True, ["a", "b"]
    changed = shlex.join(pr.get_ray_params_args(params))
    assert changed.startswith("-bv -dt") and "-dp 512 -ds" in changed and "-lw 0.000100 -i+ -av 1.000000 2.000000 3.000000" in changed
    assert "-as 7 -ab 0 -ai a -ai b -af f.amb -me" in changed
    assert pr.get_ray_params_args(pickle.loads(pickle.dumps(params))) == pr.get_ray_params_args(copy.deepcopy(params)) == shlex.split(changed)
    pr.set_ray_params(params)
    params.amblist.append("c")
    assert pr.get_ray_params().amblist == ["a", "b"] and pr.get_ray_params().ambincl == 1
    pr.set_ray_params()
    pr.set_option("-ab 8 -u -dv- -lw 1e-8 -av 1 2 3 -ae m1 -ae m2 -as 5".split())
    params = pr.get_ray_params()
    assert (params.ab, params.u, params.dv, params.lw, params.av, params.as_, params.ambincl) == (8, False, False, 1e-8, (1, 2, 3), 5, 0)
    assert params.amblist == ["m1", "m2"]
    with pytest.raises(lightwalk.OptionError, match="-ab"):
        pr.set_option(["-ad", "3", "-ab", "2.5"])
    assert pr.get_ray_params().ad == 1024
    pr.set_ray_params()
    for name, value in (("ab", 2.5), ("ab", "2"), ("ab", True), ("aa", "x"), ("av", 1), ("av", (1, 2)), ("af", 5), ("amblist", "ab"), ("u", 2), ("dt", True)):
        with pytest.raises(TypeError, match=name):
            setattr(params, name, value)
    with pytest.raises(AttributeError, match="xx"):
        params.xx = 1


def test_primitives_are_read_as_they_are_written():
    text = """# a comment, and void here
void plastic white 0 0 5 .5 .6 .7 0 0  # another
void colorpict map 7 red green blue "a b.hdr" p#q.cal u v 0 1 3
void alias paint white
white sphere ball 0 2 8 9 4 1e-3 -2 3 .5"""
    primitives = pr.parse_primitive(text)
    assert [(one.modifier, one.ptype, one.identifier, one.sargs, one.fargs) for one in primitives] == [
        ("void", "plastic", "white", [], [.5, .6, .7, 0, 0]), ("void", "colorpict", "map", ["red", "green", "blue", "a b.hdr", "p#q.cal", "u", "v"], [3]),
        ("void", "alias", "paint", ["white"], []), ("white", "sphere", "ball", [], [1e-3, -2, 3, .5])]
    for written in (b"".join(one.bytes for one in primitives), "".join(map(str, primitives))):
        assert pr.parse_primitive(written) == primitives
    assert primitives[0].bytes == b"void plastic white 0 0 5 0.5 0.6 0.7 0.0 0.0 " and primitives[2].bytes == b"void alias paint white "
    assert str(pr.Primitive("void", "mixfunc", "m", ("a", "b"), (1, 2.5, 1e-9))) == "void mixfunc m\n2 a b\n0\n3 1 2.5 1e-09\n"
    for wrong, why in (("\n!genbox m n 1 2 3", "line 2: a command"), ("a b c 0 0 0\nd e", "line 2: .*too early"), ("a b c 0\n0 2 1", "line 1: .*too early"),
                       ("a b c -1", "line 1: -1 arguments"), ("a b c x", "line 1: .*'x'")):
        with pytest.raises(lightwalk.InputError, match=why):
            pr.parse_primitive(wrong)


def test_a_scene_is_two_octrees_of_its_parts(recorder):
    recorder.answers["oconv"] = OCTREE
    for name in ("m.rad", "s.rad", "l.rad"):
        pathlib.Path(name).write_text("")
    scene = pr.Scene("room", materials=["m.rad"], surfaces=[pathlib.Path("s.rad")], views=[pr.View()], sensors=[(0, 0, 0, 0, 0, 1)])
    scene.add_material(pr.Primitive("void", "plastic", "white", [], [.5, .5, .5, 0, 0]))
    scene.add_surface(pr.Primitive("white", "sphere", "ball", [], [0, 0, 0, 1]))
    scene.add_source("l.rad")
    with pytest.raises(FileNotFoundError):
        scene.add_source("none.rad")
    assert list(scene.sources) == ["l.rad"] and scene.changed and len(scene.views) == len(scene.sensors) == 1
    scene.build()
    scene.build()
    assert recorder.calls == [(shlex.split("oconv -w m.rad -"), b"void plastic white\n0 \n0\n5 0.5 0.5 0.5 0 0\n"),
                              (shlex.split("oconv -i mroom.oct -w s.rad l.rad -"), b"white sphere ball\n0 \n0\n4 0 0 0 1\n")]
    assert not scene.changed and pathlib.Path(scene.octree).read_bytes() == OCTREE == pathlib.Path("mroom.oct").read_bytes()
    scene.remove_surface("s.rad")
    assert scene.changed
    with pytest.raises(KeyError):
        scene.remove_surface("s.rad")


def test_render_finds_rads_options(recorder):
    recorder.answers |= {"oconv": OCTREE, "vwrays": b"-x 512 -y 300 -ld-\n", "rtrace": b"picture"}
    scene = pr.Scene("room", surfaces=[pr.Primitive("void", "sphere", "ball", [], [3, 3, 3, 4])], views=[pr.View()])
    pr.render(scene, ambbounce=1)
    # As rad(1) has them for a zone from -1 to 7, and a cube of the same size.
    light = "-dp 512 -ar 32 -ms 0.2 -ds .3 -dt .07 -dc .7 -dr 1 -ss 1 -st .1 -af room.amb -aa .15 -ad 800 -as 128 -av 0.01 0.01 0.01 -lr 8 -lw 1e-4 -ab 1"
    assert recorder.calls[-1][0] == shlex.split(f"rpict {DEFAULT_VIEW} -x 512 -y 300 -ps 1 {light} room.oct")
    recorder.calls.clear()
    pr.render(scene, nproc=2, resolution=(1000, 600), ambbounce=2, ambcache=False, ncssamp=6, params=pr.get_default_ray_params())
    assert [words[0] for words, _ in recorder.calls] == ["vwrays", "vwrays", "rtrace", "getinfo"]
    assert shlex.join(recorder.calls[0][0]) == f"vwrays -c 1 -pj 0 -pd 0 -pa 1 -x 1000 -y 600 -d {DEFAULT_VIEW}"
    line = shlex.join(recorder.calls[2][0])
    assert line.startswith("rtrace -ffc -n 2 -dp") and " -ab 2 -aa 0 " in line and line.endswith("-ms 0.000000 -co+ -cs 6 -x 512 -y 300 -ld- room.oct")
    assert recorder.calls[3] == (["getinfo", "-a", f"VIEW={DEFAULT_VIEW}"], b"picture")


def test_the_cube_of_an_octree_is_found(tmp_path):
    file = tmp_path / "a.oct"
    file.write_bytes(OCTREE)
    assert _render._cube_edge(file) == 8
    for other in (b"", b"#?RADIANCE\n", b"#?RADIANCE\n\n", b"#?RADIANCE\n\n\x01\x1f-1\x00x\x00", os.urandom(300)):
        file.write_bytes(other)
        assert _render._cube_edge(file) is None


def test_the_program_answers_by_name(by_name, room_file, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    box = pr.parse_primitive(pr.genbox("mat", "name", 1, 2, 3))
    assert box[0] == pr.Primitive("mat", "polygon", "name.1540", [], [1, 0, 0, 1, 0, 3, 0, 0, 3, 0, 0, 0]) and len(box) == 6
    moved = pr.parse_primitive(pr.Xform(box[0].bytes).translate(1, 0, 0)())
    assert moved[0].fargs == [2, 0, 0, 2, 0, 3, 1, 0, 3, 1, 0, 0]
    sky = pr.gensky(datetime.datetime(2022, 2, 1, 12), 37, 122, 120)
    assert {one.ptype for one in pr.parse_primitive(sky)} == {"light", "brightfunc", "source"}
    octree = pathlib.Path("room.oct")
    octree.write_bytes(pr.oconv(room_file))
    view = pr.parse_view("-vp 0 -4 1.5 -vd 0 1 -.05 -vh 60 -vv 46.8")
    picture = pr.rpict(pr.get_view_args(view), octree, 40, 30, params=["-ab", "0"])
    assert pr.get_image_dimensions(picture) == (40, 30) and b"VIEW=" in pr.get_header(picture)
    rays = pr.vwrays(view=pr.get_view_args(view), xres=40, yres=30, outform="f")
    assert len(rays) == 40 * 30 * 24
    assert len(pr.rtrace(rays, octree, header=False, inform="f", outform="f")) == 40 * 30 * 12
    with pytest.raises(pr.ProgramError, match="none.oct"):
        pr.rtrace(rays, "none.oct")


# Of pyradiance's own tests those that are not covered, and what they call.
NOT_COVERED = {
    "TestPyradianceAPI.test_load_material_smd": "load_material_smd", "TestPyradianceCLI.test_rfluxmtx": "rfluxmtx", "TestPyradianceCLI.test_ra_tiff": "ra_tiff",
    "TestPyradianceCLI.test_genbsdf": "ShadingMaterial", "TestRtraceSimulManager.test_rtrace": "", "TestRcontribSimulManager.test_rcontrib": ""}


def test_pyradiances_own_tests_pass(by_name, tmp_path):
    if not SUITE:
        pytest.skip("pyradiance's tests are not there: LIGHTWALK_PYRADIANCE_TESTS names no folder")
    (tmp_path / "as_pyradiance.py").write_text(
        "import sys, lightwalk.pyradiance as package\n"
        "from lightwalk.pyradiance import model\n"
        "sys.modules.update({'pyradiance': package, 'pyradiance.model': model})\n")
    files = [str(file) for file in sorted(pathlib.Path(SUITE).glob("test_*.py")) if file.name not in ("test_bind.py", "test_bsdf.py")]  # no tests, scripts
    done = subprocess.run([sys.executable, "-B", "-m", "pytest", "-q", "-p", "as_pyradiance", "-p", "no:cacheprovider", "--junit-xml=report.xml", *files],
                          cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=False)
    passed, failed = [], []
    for case in xml.etree.ElementTree.parse(tmp_path / "report.xml").iter("testcase"):
        name = case.get("classname").split(".")[-1] + "." + case.get("name")
        problem = case.find("failure") if case.find("failure") is not None else case.find("error")
        if problem is None:
            passed.append(name)
        elif name not in NOT_COVERED or f"has no {NOT_COVERED[name]}" not in problem.get("message") + (problem.text or ""):
            failed.append(name)
    print(f"{len(passed)} of pyradiance's tests pass")
    assert not failed and len(passed) >= 60, done.stdout

"""Small rooms, one for each kind of BSDF and of spectral pattern: a ball and a sheet of the material, lamps before and behind.

make(name, folder) writes the scene and its files. Everything is made here; the materials' data by perf/bsdf_data.py.
"""
import math, pathlib, struct, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "perf"))
import bsdf_data as data  # noqa: E402

#: From before the room's front wall; 4:3.
VIEW = "-vtv -vp 0 -1.9 1.4 -vd 0 1 -.15 -vu 0 0 1 -vh 67.38 -vv 53.13".split()
BEHIND = "-vtv -vp .8 1.9 1.4 -vd 0 -1 -.25 -vu 0 0 1 -vh 67.38 -vv 53.13".split()
ROOM = """
void plastic wall_m 0 0 5 .6 .6 .55 0 0
void plastic red_m 0 0 5 .6 .1 .08 0 0
void plastic green_m 0 0 5 .1 .5 .12 0 0
void plastic blue_m 0 0 5 .1 .15 .6 0 0
void plastic white_m 0 0 5 .85 .85 .85 0 0
void light lamp_m 0 0 3 14 13 11
void light bulb_m 0 0 3 120 130 150
floor_m polygon floor 0 0 12 -2 -2 0  2 -2 0  2 2 0  -2 2 0
white_m polygon ceiling 0 0 12 -2 -2 3  -2 2 3  2 2 3  2 -2 3
red_m polygon left 0 0 12 -2 -2 0  -2 2 0  -2 2 3  -2 -2 3
green_m polygon right 0 0 12 2 -2 0  2 -2 3  2 2 3  2 2 0
wall_m polygon back 0 0 12 -2 2 0  2 2 0  2 2 3  -2 2 3
blue_m polygon front 0 0 12 -2 -2 0  -2 -2 3  2 -2 3  2 -2 0
lamp_m polygon lamp 0 0 12 -.4 -.7 2.98  -.4 .1 2.98  .4 .1 2.98  .4 -.7 2.98
bulb_m sphere bulb 0 0 4 1.2 1.6 2.5 .06
red_m cylinder post 0 0 7 .45 1.3 0  .45 1.3 1.6 .1
white_m cylinder post2 0 0 7 1.1 1.5 0  1.1 1.5 2 .12
blue_m sphere head 0 0 4 .45 1.3 1.7 .15
"""
BALL = "ball_m sphere ball 0 0 4 -.75 .3 .6 .55\n"
#: Its normal is towards the eye.
SHEET = "sheet_m polygon sheet 0 0 12 .15 .7 .15  1.5 .45 .15  1.5 .5 1.75  .15 .75 1.75\n"
FLOOR = "void plastic floor_m 0 0 5 .35 .3 .25 0 0\n"
SHINY = "void metal floor_m 0 0 5 .7 .65 .6 .9 .1\n"  # rough: what it mirrors is scattered light
UP = ".1 .2 1"  # nowhere along the normal of a visible point

#: Nothing is random: lobes of lights have the values of cells, what is not sampled becomes ambient light. Where lobes are sampled
#: each hit has one sample: of several Radiance loses those that bring less than some .4 % of what lights bring to the hit.
EXACT = "-ss 0 -st 1".split()
SAMPLED = "-ss 1 -st .01".split()
BOUNCE = "-ss 1 -st .01 -ab 1 -aa 0 -ad 16 -as 0".split()


def lobes(basis):
    """Four components, none of which is another's mirror image."""
    return data.matrix_file({"Transmission Back": data.gauss(.5, .12, .25, .1), "Transmission Front": data.gauss(.4, .12, -.25, -.1),
                             "Reflection Back": data.gauss(.3, .09, 0, .2, .03), "Reflection Front": data.gauss(.2, .16, .1, 0, .02)},
                            basis)


def coloured():
    """Y, X and Z of transmission and reflection: they turn from green to red with the angle."""
    text = [data.matrix_file({"Transmission Back": data.gauss(height, width), "Transmission Front": data.gauss(height, width),
                              "Reflection Back": lambda i, o, h=height: .4 * h}, data.QUARTER, wavelength=wavelength)
            for wavelength, height, width in (("CIE-X", .3, .5), ("Visible", .4, .3), ("CIE-Z", .15, .6))]
    start, end = text[0].index("<WavelengthData>"), text[0].rindex("</Layer>")
    blocks = "".join(t[t.index("<WavelengthData>"):t.rindex("</Layer>")] for t in text)
    return text[0][:start] + blocks + text[0][end:]


def tree3():
    return data.tree_file(3, {"Transmission Back": data.tree3(data.gauss(.5, .1, .1, .1, .02), 4),
                              "Reflection Back": data.tree3(data.gauss(.2, .2, 0, 0, .05), 3), "Reflection Front": "{.03}"})


def tree4():
    return data.tree_file(4, {"Transmission Back": data.tree4(data.gauss(.5, .1, .2, .1, .01), 4, coarse=3),
                              "Transmission Front": data.tree4(data.gauss(.4, .1, -.2, -.1), 3, coarse=3),
                              "Reflection Back": data.tree4(data.gauss(.3, .1), 3), "Reflection Front": "{.04}"})


def blind():
    """Slats' data: more goes down than up."""
    return data.matrix_file(data.both(data.gauss(.3, .2, 0, -.3, .02), data.gauss(.1, .3, 0, .2, .05)), data.QUARTER)


def aperture():
    return data.matrix_file(data.both(data.gauss(.1, .2, base=.02), data.gauss(.05, .3, base=.01)), through=.4)


def aperture4():
    return data.tree_file(4, data.both(data.tree4(data.gauss(.15, .12, base=.01), 5, through=.5), "{.03}"))


def hyperspectral(width=12, height=8, bands=6):
    """Hues that turn along u and fade along v, in bands from 780 to 380 nm; flat pixels of mantissas and an exponent."""
    pixels = bytearray()
    for y in range(height):
        for x in range(width):
            values = [(.5 + .45 * math.cos(2 * math.pi * (x / width - k / bands))) * (1 - .6 * y / height) for k in range(bands)]
            exponent = math.frexp(max(values))[1]
            pixels += bytes(int(math.ldexp(v, 8 - exponent)) for v in values) + struct.pack("B", exponent + 128)
    header = f"#?RADIANCE\nNCOMP={bands}\nWAVELENGTH_SPLITS= 780 588 480 380\nFORMAT=Radiance_spectra\n\n-Y {height} +X {width}\n"
    return header.encode() + bytes(pixels)


def slats():
    """Behind the sheet, within .1 of it."""
    text = ""
    for k in range(8):
        z = .2 + .19 * k
        corners = [(.15, .72, z), (1.5, .47, z), (1.5, .55, z + .07), (.15, .8, z + .07)]
        text += f"white_m polygon slat{k} 0 0 12 " + " ".join(f"{a:g} {b:g} {c:g}" for a, b, c in corners) + "\n"
    return text


def bsdf(file, kind="BSDF"):
    words = f"6 0 {file} {UP} ." if kind == "BSDF" else f"5 {file} {UP} ."
    return f"void {kind} ball_m {words} 0 0\nvoid {kind} sheet_m {words} 0 0\n"


def painted(pattern):
    return pattern + "ball_p plastic ball_m 0 0 5 .9 .9 .9 0 0\nsheet_p plastic sheet_m 0 0 5 .9 .9 .9 0 0\n"


WGMD_CAL = """{ wavy: roughness by height; tilt: a transmittance that falls with the angle }
wavy = .08 + .06*sin(9*Pz);
tilt = .2 + .5*abs(Rdot);
"""
WGMD_ROUGH = """void colorfunc tint 4 .9 .6 .3 . 0 0
void WGMDfunc ball_m 13 void .3 .1 .25  tint .3 .15 .15  void  0 0 1 . 0 9 .2 .15 .1  .1 .1 .2  .1 .1 .1
void WGMDfunc sheet_m 13 tint .4 wavy .05  void tilt .1 wavy  tint  0 0 1 rough.cal 0 9 .05 .1 .1  .1 .05 .05  .2 .2 .1
"""
WGMD_SMOOTH = """void colorfunc tint 4 .9 .7 .5 . 0 0
void WGMDfunc ball_m 13 void .25 0 0  tint .4 0 0  void  0 0 1 . 0 9 .2 .1 .1  .1 .1 .1  .1 .1 .1
void WGMDfunc sheet_m 13 void .1 0 0  tint tilt 0 0  void  0 0 1 rough.cal 0 9 .03 .03 .03  .03 .03 .03  .02 .02 .02
"""
SPECTRUM = """void spectrum ball_p 0 0 11 380 780 .1 .2 .3 .2 .1 .2 .5 .8 .9
void spectrum sheet_p 0 0 8 700 400 .2 .1 .5 .9 .6 .2
"""
SPECFILE = "void specfile ball_p 1 even.dat 0 0\nvoid specfile sheet_p 1 falling.dat 0 0\n"
SPECFUNC_CAL = """hump(nm) = .1 + .8/(1 + ((nm-arg(3))/arg(4))^2);
fall(nm) = (780 - nm)/400;
"""
SPECFUNC = "void specfunc ball_p 2 hump spectra.cal 0 4 380 780 620 60\nvoid specfunc sheet_p 2 fall spectra.cal 0 2 380 780\n"
SPECDATA_CAL = "weaker(v, nm) = v*if(nm - 600, arg(1), 1);\nheight = Pz;\n"
SPECDATA = """void specdata ball_p 4 noop table.dat spectra.cal height 0 0
void specdata sheet_p 4 weaker table.dat spectra.cal height 0 1 .3
"""
SPECPICT_CAL = """{ the middle of the picture is one unit high; wrapped around a ball at (-.75, .3, .6) }
around = 1.5*(.5 + atan2(Py-.3, Px+.75)/(2*PI));
above = .5 + (Pz-.6)/1.11;
across = (Px-.15)/1.36*1.5;
upward = (Pz-.15)/1.61;
half(v, nm) = .5*v;
"""
SPECPICT = "void specpict ball_p 5 noop hues.hsr map.cal around above 0 0\nvoid specpict sheet_p 5 half hues.hsr map.cal across upward 0 0\n"
TABLE = "2\n.1 1.6 3\n400 700 4\n.1 .2 .3 .9\n.8 .3 .6 .2\n.3 .8 .3 .1\n"
EVEN = "1\n380 780 9\n.1 .1 .6 .9 .5 .2 .1 .3 .3\n"
FALLING = "1\n700 400 7\n.2 .4 .3 .1 .1 .5 .8\n"

#: Of a scene: its materials, more surfaces, its files (texts, bytes, or what makes them), options.
SCENES = {
    "klems": (bsdf("a.xml"), "", {"a.xml": lambda: lobes(data.FULL)}, EXACT),
    "klems-sampled": (bsdf("a.xml"), "", {"a.xml": lambda: lobes(data.FULL)}, SAMPLED),
    "klems-behind": (bsdf("a.xml"), "", {"a.xml": lambda: lobes(data.FULL)}, SAMPLED),
    "klems-colour": (bsdf("a.xml"), "", {"a.xml": coloured}, SAMPLED),
    "tree3": (bsdf("a.xml"), "", {"a.xml": tree3}, EXACT),
    "tree3-sampled": (bsdf("a.xml"), "", {"a.xml": tree3}, SAMPLED),
    "tree4": (bsdf("a.xml"), "", {"a.xml": tree4}, EXACT),
    "tree4-sampled": (bsdf("a.xml"), "", {"a.xml": tree4}, SAMPLED),
    "proxy": (f"void BSDF ball_m 6 0 a.xml {UP} . 0 0\nvoid BSDF sheet_m 6 .12 a.xml {UP} . 0 0\nvoid BSDF rear_m 6 -.12 a.xml {UP} . 0 0\n",
              slats() + SHEET.replace("sheet", "rear").replace(" .7 ", " .82 ").replace(" .75 ", " .87 ")
              .replace(" .45 ", " .57 ").replace(" .5 ", " .62 "), {"a.xml": blind}, BOUNCE),
    "aperture": (bsdf("a.xml", "aBSDF"), "", {"a.xml": aperture}, SAMPLED),
    "aperture-tree4": (bsdf("a.xml", "aBSDF"), "", {"a.xml": aperture4}, SAMPLED),
    "wgmd": (WGMD_ROUGH, "", {"rough.cal": WGMD_CAL}, SAMPLED),
    "wgmd-smooth": (WGMD_SMOOTH, "", {"rough.cal": WGMD_CAL}, EXACT),
    "spectrum": (painted(SPECTRUM), "", {}, EXACT),
    "specfile": (painted(SPECFILE), "", {"even.dat": EVEN, "falling.dat": FALLING}, EXACT),
    "specfunc": (painted(SPECFUNC), "", {"spectra.cal": SPECFUNC_CAL}, SAMPLED),
    "specdata": (painted(SPECDATA), "", {"table.dat": TABLE, "spectra.cal": SPECDATA_CAL}, EXACT),
    "specpict": (painted(SPECPICT), "", {"hues.hsr": hyperspectral, "map.cal": SPECPICT_CAL}, EXACT),
}


def view_of(name):
    return BEHIND if name.endswith("-behind") else VIEW


def make(name, folder):
    """Write room.rad and what it names into the folder."""
    materials, surfaces, files, options = SCENES[name]
    floor = SHINY if options is BOUNCE else FLOOR
    (folder / "room.rad").write_text(materials + floor + ROOM + BALL + SHEET + surfaces)
    for file, content in files.items():
        content = content() if callable(content) else content
        (folder / file).write_bytes(content if isinstance(content, bytes) else content.encode())

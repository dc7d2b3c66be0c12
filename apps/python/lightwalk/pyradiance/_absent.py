"""What pyradiance has and this package has not: for each name a sentence that says what to use."""

from __future__ import annotations

from .._errors import Error

_RADIANCE = "use Radiance's own program; Lightwalk reads what it writes"
_NUMPY = "numpy does this with arrays: numpy.frombuffer(...) of rtrace(..., outform='f') or pvalue(..., outform='f'), or what lightwalk.Scene returns"
_MATRIX = "multiply arrays by numpy's @: lightwalk.Scene.contrib(...) returns them"
_TRACE = "use lightwalk.Scene.trace(...) and contrib(...): several scenes in a process, arrays in and out"
_PICTURE = "use lightwalk.save_picture(...), or lightwalk render -o FILE.png, .jpg, .exr or .hdr"
_BUILT_IN = "scene files may call it: the line \"!{name} FILE\" is read without the program"
_SPECTRAL = "pictures have three channels here; use Radiance's own program"

_SENTENCES = {
    "_RADIANCE": ("GenGlaze GlazingLayerData GlazingType SpectralPoint genglaze_data genglaze_json BlindsGeometry ShadingMaterial generate_blinds "
                  "generate_blinds_for_bsdf generate_bsdf generate_xml genbsdf bsdf WrapBSDF bsdf2klems bsdf2ttree pabopto2bsdf mgf2rad robjutil "
                  "mkillum rfluxmtx cv"),
    "_NUMPY": "Pcomb pcomb pcompos pextrem Rcomb rcomb cal cnt rcalc rlam total rcode_depth rcode_ident rcode_norm",
    "_MATRIX": "dctimestep rmtxop Rmtxop rcollate",
    "_TRACE": ("RtraceSimulManager RcontribSimulManager RpictSimulManager RcOutputOp RTdoFIFO RTimmIrrad RTlimDist RTmask RTtraceSources RCCONTEXT "
               "calcontext eval initfunc loadfunc set_eparams rsensor radiance_ext"),
    "_PICTURE": "ra_ppm ra_rgbe ra_tiff ra_xyze pvaluer",
    "_BUILT_IN": "ies2rad obj2rad",
    "_SPECTRAL": "genssky gensdaymtx setspectrsamp spec_xyz xyz_rgb",
}
_SINGLE = {
    "BINPATH": "`lightwalk install-names FOLDER` makes a folder of the programs",
    "Resolu": "use get_image_dimensions()",
    "gendaymtx": "use Radiance's own program, and multiply its matrix by what Rcontrib or lightwalk.Scene.contrib(...) return",
    "getbbox": "use lightwalk.Scene.from_files(...).bounds",
    "load_material_smd": "scenes may hold the spectrum itself: a \"spectrum\" primitive as the modifier of a material",
    "mkpmap": "there are no photon maps; indirect light is that of -ab",
    "obj2mesh": "scenes take object files as they are: \"mesh\" primitives, and files on the command line",
    "pcond": "use --tone and --exposure of lightwalk render, and .png or .jpg",
    "pkgbsdf": "scene files may call it: the line \"!pkgBSDF -s FILE\" is read without the program",
}


def _table() -> dict[str, str]:
    found = dict(_SINGLE)
    for sentence, names in _SENTENCES.items():
        for name in names.split():
            found[name] = globals()[sentence].replace("{name}", name)
    return found


#: A sentence for each name.
ABSENT = _table()


class NotCovered(Error, AttributeError):
    """Something that pyradiance has and this package has not."""


def refusal(name: str) -> AttributeError:
    """What a module raises for a name that it has not."""
    if name in ABSENT:
        return NotCovered(f"lightwalk.pyradiance has no {name}: {ABSENT[name]}")
    return AttributeError(f"module 'lightwalk.pyradiance' has no attribute {name!r}")

"""Compares the variants: speed-up over one thread, and errors against a converged picture."""
import pathlib, sys, tempfile

from experiments import picture, print_table, save
from runs import ROOT, Split, about, measure

sys.path.append(str(ROOT / "perf"))  # the package walk; as it needs NumPy, it is imported where it is used


def speedup(program, options):
    """One thread against all cores at hand, in one process and in ranks; with ambient light also with ranks of their own
    for the master and the ambient values. By medians, and by least times."""
    scene, cores, rows = program.scene, options.cores, []
    splits = [Split(), Split("threads", 1, cores), Split("hybrid", 1, cores), Split("hybrid", cores, 1)]
    works = {"direct": ([*splits, Split("ranks", cores + 1)], 2 * options.size, ()),
             "ambient": ([*splits, Split("ranks", cores + 2)], options.size, scene.ambient)}
    cases = {(light, split): (split, ["-vf", scene.views[0], *picture(size), *extra])
             for light, (list_, size, extra) in works.items() for split in list_}
    found = measure(program, cases, options.runs)
    for (light, split), one in found.items():
        base = found[(light, Split())]
        rows.append({"light": light, "split": str(split), "median": one["seconds"], "least": one["least"],
                     "speedup": base["seconds"] / one["seconds"], "of_least": base["least"] / one["least"],
                     "others": one["others"]})
    print_table(rows)
    save(options.out, "speedup", about(scene, options.size), cores=cores, rows=rows)


def rendered(program, split, words, folder):
    """Luminances of a picture, and the run's statistics."""
    from walk import pictures
    path = folder / "picture.hdr"
    stats = program.render(split, words, path)
    return pictures.luminance(pictures.read_hdr(path)), stats


def error(found, truth):
    """Root of the mean squared difference, as a share of the mean."""
    return float(((found - truth) ** 2).mean() ** 0.5 / truth.mean())


def middle(numbers):
    return sorted(numbers)[len(numbers) // 2]


def accuracy(program, options):
    """Two bounces of ambient light: the error of each variant against a picture with many more rays in which no ambient
    values are shared, and its number of ambient rays, with and without exchange."""
    scene, rows = program.scene, []
    start = scene.ambient.index("-av")
    values = [*scene.ambient[start:start + 4]]
    size = picture(max(16, options.size // 3))
    words = ["-vf", scene.views[0], *size, "-ab", 2, "-aa", ".25", "-ad", 128, "-as", 0, "-ar", 64, *values]
    splits = [Split(), Split("threads", 1, options.cores), Split("hybrid", 1, 2), Split("hybrid", 2), Split("hybrid", 4),
              Split("ranks", 4), Split("ranks", 6)]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        fine = ["-vf", scene.views[0], *size, "-ab", 2, "-aa", 0, "-ad", options.truth, "-as", 0, *values]
        truth, _ = rendered(program, Split("threads", 1, options.cores), fine, folder)
        for split in splits:
            batches = (0, 16) if split.ranks > 1 else (16,)
            runs = {batch: [rendered(program, split, [*words, "--ambient-batch", batch], folder)
                            for _ in range(options.runs)] for batch in batches}
            rays = {batch: middle([stats["rays"]["ambient"] for _, stats in list_]) for batch, list_ in runs.items()}
            rows.append({"split": str(split), "error": middle([error(found, truth) for found, _ in runs[16]]),
                         "ambient_rays": rays[16], "without_exchange": rays.get(0, rays[16]),
                         "saved": 1 - rays[16] / rays.get(0, rays[16])})
    print_table(rows)
    save(options.out, "accuracy", about(scene, options.size), truth=options.truth, rows=rows)

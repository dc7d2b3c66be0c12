"""The scaling model: its input is measured, its predictions are compared with measured runs, and then it predicts runs
on other machines."""
import copy, json, os, statistics

import svg_plot
from experiments import PAPER, picture, print_table, save
from runs import Split, about, measure, mpirun

#: LogGP figures of other machines; perf/README.md says where they come from.
CLUSTER = {"name": "a cluster of today", "latency": 1.5e-6, "overhead": 1e-6, "gap": 3e-7, "byte_gap": 8e-11,
           "byte_work": 3e-10}
T3E = {"name": "Cray T3E-900", "latency": 6e-6, "overhead": 5e-6, "gap": 5e-6, "byte_gap": 3.3e-9, "byte_work": 1e-10,
       "step": 1e-8, "value_work": 1e-8, "sleeps": False, "unpacks": False, "slowness": 100, "wake": 0}
WIDTH_4K = 3840


def write_cost_map(program, path, view, size, extra, threads):
    path.write_text(program.run([program.beside("cost_map"), "-vf", view, *picture(size), *extra, "-n", threads,
                                 *program.scene.words]))


def measure_machine(program):
    """LogGP figures of this machine: the best of a few runs, as disturbances only increase them."""
    runs = [json.loads(program.run([*mpirun(2), program.beside("message_bench")])) for _ in range(3)]
    return {name: min(run[name] for run in runs) for name in runs[0]}


def width(options, light):
    """The size of the measured pictures. With direct light alone they are larger, so that runs last long enough for timing."""
    return 2 * options.size if light == "direct" else options.size


def model_inputs(program, options, view, extra, tag):
    """Cost map and machines; the files stay in the folder, for --predict-only."""
    path = options.out / f"cost-{program.scene.name}-{tag}.json"
    costs = options.out / "message-costs.json"
    if not (options.predict_only and path.is_file()):
        write_cost_map(program, path, view, width(options, tag), extra, options.cores)
    if not (options.predict_only and costs.is_file()):
        costs.write_text(json.dumps(measure_machine(program), indent=1) + "\n")
    crowding = json.loads(path.read_text())["crowding"]
    here = {**json.loads(costs.read_text()), "node_cores": options.cores, "node_ranks": 0, "crowding": crowding}
    return {"map": str(path), "machines": {"here": here, "cluster": CLUSTER, "t3e": T3E,
                                            "forwarding": {**CLUSTER, "unpacks": False}}}


def predict(program, out, tag, inputs, cases):
    path = out / f"cases-{tag}.json"
    path.write_text(json.dumps({**inputs, "cases": cases}, indent=1) + "\n")
    return json.loads(program.run([program.beside("scaling_model"), path]))["predictions"]


def case(name, split, machine="here", **more):
    return {"name": name, "machine": machine, "variant": split.variant, "ranks": split.ranks, "threads": split.threads,
            **more}


def validation_cases(cores):
    """The runs that this machine can make: [(split, options, the same for the model)]."""
    found = [(Split("threads", 1, n), [], {}) for n in sorted({1, cores})]
    found += [(Split("ranks", n), [], {}) for n in (3, 4, 5, 9)]
    found += [(Split("hybrid", *split), [], {}) for split in ((1, 2), (2, 1), (2, 2), (4, 1))]
    found.append((Split("ranks", 5), ["--stride", 1], {"stride": 1}))
    found.append((Split("ranks", 5), ["--block", 16], {"block": 16}))
    return found


def background(measured, cases):
    """How many threads of other programs were always ready to run, estimated from the share of the cores that they took."""
    shares = []
    for name, one in measured.items():
        split = cases[name][0]
        tracing = split.threads if split.variant == "threads" else split.cores() - (split.variant == "ranks")
        shares.append(tracing * one["others"] / max(1e-3, 1 - one["others"]))
    return statistics.median(shares)


def calibrate(program, options, inputs, measured, light):
    """How fast this machine's cores were while the runs were measured, one alone and all at once: from the runs
    without ranks, by which the other predictions then stand or fall. Both vary from hour to hour."""
    here = inputs["machines"]["here"]
    here |= {"slowness": 1, "crowding": [1]}
    names = [str(Split("threads", 1, n)) for n in sorted({1, options.cores})]
    wanted = [case(name, Split("threads", 1, int(name.split()[1]))) for name in names]
    found = {p["name"]: p["seconds"] for p in predict(program, options.out, f"calibration-{light}", inputs, wanted)}
    slow = [measured[name]["seconds"] / found[name] for name in names]
    here["slowness"] = slow[0]
    most = max(1, slow[-1] / slow[0])
    here["crowding"] = [1 + (most - 1) * k / max(1, options.cores - 1) for k in range(options.cores)]
    print(f"{light}: cores are {slow[0]:.2f} times as slow as for the cost map, {most:.2f} times that when all are busy")
    return names


def validate(program, options, inputs_of):
    scene, view, rows = program.scene, program.scene.views[0], []
    for light, extra in (("direct", ()), ("ambient", scene.ambient)):
        inputs, size = copy.deepcopy(inputs_of[light]), picture(width(options, light))
        cases, wanted = {}, []
        for split, words, more in validation_cases(options.cores):
            name = " ".join(map(str, [split, *words]))
            cases[name] = (split, ["-vf", view, *size, *extra, *words])
            wanted.append(case(name, split, **more))
        if light == "ambient":
            name = "ranks 4 --ambient-batch 0"
            cases[name] = (Split("ranks", 4), ["-vf", view, *size, *extra, "--ambient-batch", 0])
            wanted.append(case(name, Split("ranks", 4), ambient_batch=0))
        measured_file = options.out / f"measured-{light}.json"
        if options.predict_only and measured_file.is_file():
            measured = json.loads(measured_file.read_text())
        else:
            measured = measure(program, cases, options.runs)
            measured_file.write_text(json.dumps(measured, indent=1) + "\n")
        inputs["machines"]["here"]["background"] = background(measured, cases)
        print(f"{light}: other programs' threads beside ours: {inputs['machines']['here']['background']:.2f}")
        given = calibrate(program, options, inputs, measured, light)
        for p in predict(program, options.out, f"validation-{light}", inputs, wanted):
            one = measured[p["name"]]
            rows.append({"light": light, "run": p["name"], "measured": one["seconds"], "least": one["least"],
                         "most": one["most"], "others": one["others"], "given": p["name"] in given,
                         "predicted": p["seconds"], "error": p["seconds"] / one["seconds"] - 1, "values": one["ambient_values"],
                         "values_predicted": p.get("values_made", 0)})
    print_table(rows)
    errors = [abs(r["error"]) for r in rows if not r["given"]]
    print(f"{sum(e <= 0.1 for e in errors)} of {len(errors)} within 10 %; median {statistics.median(errors):.1%}")
    series = {light: [(r["measured"], r["predicted"]) for r in rows if r["light"] == light]
              for light in ("direct", "ambient")}
    ends = [min(r["measured"] for r in rows), max(r["measured"] for r in rows)]
    series["equal"] = [(e, e) for e in ends]
    svg_plot.write_lines(options.out / "model-validation.svg", f"Predicted against measured, {scene.name}",
                         "measured, the median [s]", "predicted [s]", series, x_log=0, points=("direct", "ambient"))
    return rows


def t3e(program, options, inputs):
    """The paper's table: a base of one processor, then a master and workers."""
    wanted = [case(str(n), Split("ranks", n), "t3e", masters=1, width=640, height=480) for n in (2, *PAPER)]
    found = {p["name"]: p for p in predict(program, options.out, "t3e", inputs, wanted)}
    base = found["2"]["seconds"]  # one worker and a master
    rows = [{"PEs": n, "paper": paper, "paper_a_worker": paper / (n - 1), "model": found[str(n)]["speedup"],
             "model_a_worker": found[str(n)]["speedup"] / (n - 1), "over_2_PEs": base / found[str(n)]["seconds"],
             "master_busy": found[str(n)]["master_busy"]} for n, paper in PAPER.items()]
    print_table(rows)
    lines = {"paper": list(PAPER.items()), "model": [(r["PEs"], r["model"]) for r in rows],
             "workers": [(n, n - 1) for n in PAPER]}
    svg_plot.write_lines(options.out / "model-t3e.svg", "The paper's Table 1, and the model with a T3E's figures",
                         "processors", "speed-up", lines, y_log=2)
    return rows


def large_cases(height, ambient):
    """A 4K picture on 1 to 65,536 cores. `work`: times what a pixel of the cost map takes."""
    cases = []
    size = {"width": WIDTH_4K, "height": height}
    works = (1,) if ambient else (1, 16, 256)
    for cores in [4**k for k in range(1, 9)]:
        for work in works:
            for threads in (1, 16, 64):
                if cores < 4 * threads and threads > 1:
                    continue
                variants = ("ranks", "hybrid") if threads == 1 else ("hybrid",)
                for variant in variants:
                    if ambient and variant == "hybrid" and threads == 1:
                        continue
                    for masters in (1, 0):
                        ranks = cores // threads
                        if masters == 0 and ranks <= 256:
                            continue  # the same as one master
                        tree = "tree" if masters == 0 else "one"
                        cases.append(case(f"{variant} {ranks}x{threads} {tree} work {work}",
                                          Split(variant, ranks, threads), "cluster", masters=masters, work=work,
                                          node_cores=threads, node_ranks=1, cores=cores, tree=tree, **size))
    if not ambient:
        for more in ({"block": 8}, {"block": 32}, {"stride": 1}):
            cases.append(case(f"ranks 4096x1 tree work 16 {more}", Split("ranks", 4096), "cluster", work=16,
                              node_cores=1, node_ranks=1, cores=4096, tree="tree", **more, **size))
        for work in (1, 4, 16, 64, 256):
            for ranks, threads in ((4096, 1), (64, 64)):
                variant = "ranks" if threads == 1 else "hybrid"
                cases.append(case(f"{variant} {ranks}x{threads} forwarding work {work}", Split(variant, ranks, threads),
                                  "forwarding", work=work, node_cores=threads, node_ranks=1, cores=4096,
                                  tree="forwarding", **size))
        for masters in (2, 5, 17, 33, 65, 129):
            cases.append(case(f"ranks 4096x1 {masters} masters work 16", Split("ranks", 4096), "cluster", work=16,
                              node_cores=1, node_ranks=1, cores=4096, masters=masters, tree=str(masters), **size))
    else:
        for batch in (0, 4, 64, 256):
            for ranks, threads in ((64, 1), (1024, 1), (64, 16)):
                variant = "ranks" if threads == 1 else "hybrid"
                cases.append(case(f"{variant} {ranks}x{threads} batch {batch}", Split(variant, ranks, threads), "cluster",
                                  ambient_batch=batch, node_cores=threads, node_ranks=1, cores=ranks * threads,
                                  tree="auto", work=1, **size))
    return cases


def predict_large(program, options, inputs, tag):
    cells = json.loads(open(inputs["map"]).read())["picture"]
    height = WIDTH_4K * cells["height"] // cells["width"]
    found = predict(program, options.out, f"large-{tag}", inputs, large_cases(height, tag == "ambient"))
    rows = [{"run": p["name"], "cores": p["cores"], "seconds": p["seconds"], "speedup": p["speedup"],
             "efficiency": p["efficiency"], "master_busy": p["master_busy"], "busiest_busy": p["busiest_busy"],
             "blocks": p["blocks"], **({"values": p["values_made"]} if "values_made" in p else {})} for p in found]
    print_table(rows)
    lines = {}
    for p in found:
        many = p["variant"] == "ranks" or tag == "ambient" and p["threads"] == 16
        few = p["threads"] == 64 and p["tree"] == "one" and p["work"] > 1
        if p["tree"] in ("one", "tree") and "{" not in p["name"] and (many or few):
            masters = "one master" if p["tree"] == "one" else "tree"
            work = "" if tag == "ambient" else f", work {p['work']}"
            kind = f"{p['variant']} x{p['threads']}, {masters}{work}"
            lines.setdefault(kind, []).append((p["cores"], p["efficiency"]))
    svg_plot.write_lines(options.out / f"model-large-{tag}.svg", f"A 4K picture of the {program.scene.name}, {tag} light",
                         "cores", "efficiency", lines, x_log=2, y_high=1)
    return rows


def run(program, options):
    view, scene = program.scene.views[0], program.scene
    inputs = {light: model_inputs(program, options, view, extra, light)
              for light, extra in (("direct", ()), ("ambient", scene.ambient))}
    rows = validate(program, options, inputs)
    paper = t3e(program, options, inputs["direct"])
    large = predict_large(program, options, inputs["direct"], "direct")
    large_ambient = predict_large(program, options, inputs["ambient"], "ambient")
    save(options.out, "model", about(scene, options.size), machine_figures=inputs["direct"]["machines"], validation=rows, t3e=paper,
         large=large, large_ambient=large_ambient, cores_at_hand=os.cpu_count())

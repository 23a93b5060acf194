"""The paper's comparison of contact searches (Table 4, Fig. 13) and its update intervals (Fig. 14)."""

import json

from . import states
from .common import Report, build, in_turn, median, number, overrides, perf, quick, repeats, run, states as folder, step_timer

#: Granules; the radius follows from the total mass, that of 1,246 granules of 0.56 mm.
COUNTS = (312, 500, 700, 900, 1200, 1246)
FULL_RADIUS, FULL_COUNT = 0.56e-3, 1246
SEARCHES = ("all pairs", "full grid", "half-shell grid", "half-shell and list")


def radius_of(count):
    return FULL_RADIUS * (FULL_COUNT / count) ** (1.0 / 3.0)


def cylinder(count):
    """The damper with `count` granules at rest, and the same granules by explicit positions."""
    text = (perf / "scenes" / "paper_cylinder.toml").read_text(encoding="utf-8")
    settings = {"granules.0.count": count, "granules.0.radius": f"{radius_of(count):.12g}"}
    name = f"cylinder_{count}"
    if not (folder / f"{name}.csv").exists():
        states.end_state(text, name, {**settings, "time.duration": 2.0e-5})
    explicit = states.replaced(text, "count   = 1246\nradius  = 0.56e-3", f'file    = "{name}.csv"')
    explicit = states.replaced(explicit, '[packing]\nkind = "settled"\n', "")
    file = folder / f"{name}.toml"
    file.write_text(explicit, encoding="utf-8")
    return file


def full_search(file, settings, search, steps, warm):
    return json.loads(run([build / "perf" / "full_search", file, *overrides(settings), "--search", search, "--steps", steps,
                           "--warm", warm]))


def ratio(times, others):
    """Of runs of one turn, between which the machine has changed least; the median."""
    return median([a / b for a, b in zip(times, others)])


def table4():
    steps, warm = (200, 100) if quick else (4000, 2000)
    rows, ratios, calibration = [], [], []
    counts = COUNTS[::5] if quick else COUNTS
    curves = {search: [] for search in SEARCHES}
    for count in counts:
        file = cylinder(count)
        program = lambda policy: lambda: step_timer(file, {"verlet.policy": policy}, steps=steps, warm=warm)  # noqa: E731
        time_step = step_timer(file, steps=1, warm=0)["time_step"]
        fixed = {"time.step": time_step}
        taken = in_turn({"all pairs": program("all-pairs"),
                         "full grid": lambda: full_search(file, fixed, "full", steps, warm),
                         "half-shell grid": program("none"),
                         "half-shell and list": program("guarded"),
                         "half, plain driver": lambda: full_search(file, fixed, "half", steps, warm)})
        times = {key: [t["processor_ns_per_step"][0] / 1000.0 for t in of] for key, of in taken.items()}
        time = {key: median(of) for key, of in times.items()}
        last = taken["half-shell and list"][-1]
        rows.append([count, f"{1e3 * radius_of(count):.3f}", *(number(time[s]) for s in SEARCHES),
                     number(last["contacts_per_granule"]), number(last["mean_interval"])])
        ratios.append([count, *(f"{ratio(times[s], times['half-shell and list']):.1f}" for s in SEARCHES[:3])])
        calibration.append([count, f"{ratio(times['half, plain driver'], times['half-shell grid']):.2f}"])
        for search in SEARCHES:
            curves[search].append((count, time[search]))
    report = Report("paper_table4", "Table 4 and Fig. 13: four contact searches", f"""A cylinder of 10 x 24.64 mm, granules of one total mass, free vibration (perf/scenes/paper_cylinder.toml). Processor
time per step, us, one thread, medians of {repeats} runs in turn of {steps} steps after {warm}; ratios: of the runs of one turn,
medians. All pairs, half-shell grid at every step and half-shell with list are the program's policies `all-pairs`, `none`
and `guarded`; the full grid (all 26 neighbouring cells and the own one, each pair found from both sides) exists in
perf/full_search.cpp alone, with the same kernels for forces, walls and motion.
All searches use the same vector kernel, all pairs too: the paper's were scalar.""")
    report.table(["granules", "radius, mm", *SEARCHES, "contacts per granule", "steps per list"], rows)
    report.table(["granules", *(f"{s} / half-shell and list" for s in SEARCHES[:3])], ratios,
                 "Ratios (paper, 1,200 granules: 18.6 against all pairs, 2.9 against the half-shell grid without list)")
    report.table(["granules", "half-shell grid, plain driver / program"], calibration,
                 "What the plain driver adds to the full grid's time")

    def draw(axes):
        for search, points in curves.items():
            axes.semilogy(*zip(*points), "o-", label=search)
        axes.set_xlabel("granules")
        axes.set_ylabel("us per step")
        axes.legend()

    report.picture(draw)
    report.write()


def fig14():
    file = cylinder(1200)
    duration = 0.02 if quick else 0.2
    steps = int(duration / step_timer(file, steps=1, warm=0)["time_step"])
    rows, curves = [], {}
    for policy in ("guarded", "predicted", "displacement"):
        log = folder / f"intervals_{policy}.csv"
        of = step_timer(file, {"verlet.policy": policy, "verlet.skin": 0.2, "verlet.audit": 50}, steps=steps, intervals=log)
        points = [tuple(map(float, line.split(","))) for line in log.read_text(encoding="utf-8").splitlines()[1:]]
        curves[policy] = points
        lengths = [n for _, n in points]
        rows.append([policy, of["builds"], number(of["mean_interval"]), int(min(lengths)), number(median(lengths)),
                     int(max(lengths)), of["missed"]])
    report = Report("paper_fig14", "Fig. 14: steps between lists", f"""The cylinder of Table 4 with 1,200 granules over {duration} s of free vibration, skin 0.2 d, three rules from the same start: the
program's (`guarded`: the sum of v_max dt), the paper's (`predicted`: v_max at the last list alone, safety 1.5, at most
150 steps) and exact displacements. Missed: contacts that began unlisted, from comparing with all pairs every 50 steps.""")
    report.table(["rule", "lists", "mean steps per list", "least", "median", "most", "missed contacts"], rows)

    def draw(axes):
        for policy, points in curves.items():
            axes.plot(*zip(*points), ".", markersize=2, label=policy)
        axes.set_xlabel("time, s")
        axes.set_ylabel("steps between lists")
        axes.legend()

    report.picture(draw)
    report.write()

"""Fig. 11: free vibration of Table 2's cylinder, specific damping capacity against amplitude."""

import numpy

from .page import Section, percent
from .settings import FREE_AMPLITUDES, FREE_DURATION, FREE_SEEDS
from .statistics import Mean, apart

MASS, STIFFNESS, DAMPING = 0.0376, 470.0, 0.004  #: of the scene, SI
LAWS = {"spring": {}, "Coulomb": {"contact.friction": '"coulomb"'}}
RATIO = DAMPING / (2.0 * numpy.sqrt(MASS * STIFFNESS))
BARE = 1.0 - numpy.exp(-4.0 * numpy.pi * RATIO / numpy.sqrt(1.0 - RATIO ** 2))


def classes(cycles):
    """Mean amplitude (mm) and capacity of the cycles in each class of amplitude; nan where there are none."""
    amplitude = 1e3 * numpy.array([c["amplitude"] for c in cycles])
    capacity = numpy.array([c["specific_damping_capacity"] for c in cycles])
    rows = []
    for low, high in zip(FREE_AMPLITUDES, FREE_AMPLITUDES[1:]):
        inside = (amplitude >= low) & (amplitude < high)
        rows.append((amplitude[inside].mean(), capacity[inside].mean()) if inside.any() else (numpy.nan, numpy.nan))
    return numpy.array(rows)


def turning_points(time, x):
    """Time and height of the upper turning points, each the top of the parabola through three samples."""
    k = numpy.flatnonzero((x[1:-1] >= x[:-2]) & (x[1:-1] > x[2:]) & (x[1:-1] > 0.05 * x.max())) + 1
    bend = x[k - 1] - 2.0 * x[k] + x[k + 1]
    return time[k], x[k] - (x[k + 1] - x[k - 1]) ** 2 / (8.0 * bend)


def fig11(runs):
    timed = {"time.duration": FREE_DURATION, "output.window": f"[0.0, {FREE_DURATION}]", "output.history_interval": 5.0e-4}
    oracle = runs.start_oracle("table2", {**timed, "output.energy": "false"})
    begun = {law: [runs.start("table2", {**timed, **extra}, seed) for seed in FREE_SEEDS] for law, extra in LAWS.items()}
    yield
    section = Section("fig11", "free vibration with 130 granules: specific damping capacity")
    section.text(f"""`io/scenes/table2.toml`: 130 granules in the cylinder of 5.25 x 8.84 mm, let go vertically from 15.7 mm; friction by spring, dashpot and
        slider (the paper's), and by Coulomb's law. Specific damping capacity: kinetic energy lost in a cycle over its peak. {len(FREE_SEEDS)} packings by each
        law, {FREE_DURATION:g} s; cycles of each are averaged in classes of amplitude, then packings. The structure's mass, stiffness and damping and the
        granules' size are assumed (the scene says what); the paper prints a curve, so nothing can be said to agree with it but the shape.""")
    cycles = {law: [run.result().structure["cycles"] for run in these] for law, these in begun.items()}
    rows = {law: numpy.array([classes(c) for c in these]) for law, these in cycles.items()}
    table, distances = [], []
    for k, (low, high) in enumerate(zip(FREE_AMPLITUDES, FREE_AMPLITUDES[1:])):
        values = {law: rows[law][:, k, 1] for law in LAWS}
        if any(numpy.isnan(v).any() for v in values.values()):
            continue
        means = {law: Mean(100 * v) for law, v in values.items()}
        distances.append(apart(*means.values()))
        table.append([f"{low:g} to {high:g}", means["spring"].text(2), means["Coulomb"].text(2), f"{distances[-1]:.1f}"])
    section.table(["amplitude, mm", "spring, %", "Coulomb, %", "standard errors between"], table)

    with numpy.errstate(invalid="ignore"):
        means = {law: (numpy.nanmean(rows[law][:, :, 0], 0), numpy.nanmean(rows[law][:, :, 1], 0),
                       numpy.nanstd(rows[law][:, :, 1], 0, ddof=1)) for law in LAWS}
    history = oracle.result()
    time, height = turning_points(history["time"], history["displacement"])
    ours = []
    for run in begun["spring"]:
        t, x = run.result().history("time", "displacement")
        ours.append(numpy.interp(time, *turning_points(t, x)))
    ours = numpy.array(ours)
    inside = height > 2.0e-3
    # The envelope as a whole: the time to fall to half, and the largest distance, both in deviations of one run.
    falls = Mean(numpy.interp(-0.5 * height[0], -o, time) for o in ours)
    fall = float(numpy.interp(-0.5 * height[0], -height, time))
    off = abs(fall - falls.mean) / falls.deviation

    def draw(axes):
        for c, (law, (a, s, d)) in enumerate(means.items()):
            axes[0].errorbar(a * (1.0 + 0.01 * c), 100 * s, 100 * d, fmt="o-" if c == 0 else "s--", markersize=3.5, capsize=3, linewidth=0.9,
                             label=f"{law}, deviation of one run")
        one = cycles["spring"][0]
        axes[0].plot([1e3 * c["amplitude"] for c in one], [100 * c["specific_damping_capacity"] for c in one], ".", color="0.75", markersize=2,
                     zorder=0, label="spring, each cycle of seed 1")
        axes[0].axhline(100 * BARE, color="k", linestyle=":", linewidth=0.8, label="bare structure")
        axes[0].set_xlabel("amplitude, mm")
        axes[0].set_ylabel("specific damping capacity, %")
        axes[0].set_ylim(0)
        for k, o in enumerate(ours):
            axes[1].plot(time, 1e3 * o, "C0", linewidth=0.8, label="spring, seeds" if k == 0 else None)
        axes[1].plot(time[::6], 1e3 * height[::6], "m.", markersize=3, label="oracle, seed 1")
        axes[1].plot(time, 1e3 * height[0] * numpy.exp(-RATIO * numpy.sqrt(STIFFNESS / MASS) * time), "k:", linewidth=0.8, label="bare structure")
        axes[1].set_xlabel("time, s")
        axes[1].set_ylabel("upper turning points, mm")
        axes[1].set_ylim(0)
        for axis in axes:
            axis.legend()

    section.picture(draw, columns=2, size=(8.4, 3.6))
    a, s, _ = means["spring"]
    top = int(numpy.nanargmax(s))
    most = max(distances)
    section.text(f"""The capacity rises as the amplitude falls, to {percent(s[top])} near {a[top]:.1f} mm, and vanishes below that, where the granules no longer leave
        the floor (1 g is {1e3 * 9.81 * MASS / STIFFNESS:.2f} mm): the amplitude falls along a nearly straight line (right), as impact dampers have it. The bare
        structure has {percent(BARE, 2)}. By spring and by Coulomb's law the capacities are at most {most:.1f} standard errors apart:
        {"no difference" if most < 3 else f"Coulomb's law takes more between 3 and 16 mm, by {percent(numpy.mean((means['Coulomb'][1] / s)[a > 3.0]) - 1.0, 0)}"}.""",
                 f"""The scalar oracle, spring, seed 1, all {FREE_DURATION:g} s: it falls to half in {fall:.3f} s, the program in {falls.text(3)} s
        ({off:.1f} deviations of one run).""")
    capacity = [c["specific_damping_capacity"] for c in cycles["spring"][0]]
    residual = max(run.result().energy["residual"] for these in begun.values() for run in these)
    section.check("oracle's time to fall to half", off < 4.0, f"{off:.1f} deviations", "below 4")
    section.check("capacity above the bare structure's at large amplitude", numpy.mean(capacity[:5]) > 1.5 * BARE, percent(numpy.mean(capacity[:5]), 2),
                  f"above {percent(1.5 * BARE, 2)}")
    section.check("energy balance", residual < 0.01, f"{residual:.1e}", "below 0.01")
    section.verdict = f"a curve only: {percent(s[top], 0)} at most, near {a[top]:.1f} mm; spring and Coulomb friction {'agree' if most < 3 else 'differ a little'}"
    yield section

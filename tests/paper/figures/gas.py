"""Fig. 8: granules in a closed box without gravity lose their energy."""

import numpy

from .page import Section, percent
from .settings import GAS_MORE_SEEDS, GAS_SEEDS
from .statistics import Mean, apart, apart_from

TIMES = (1.0e-3, 2.0e-3, 5.0e-3, 10.0e-3, 20.0e-3)
INDEPENDENT = {1.0e-3: 0.685, 2.0e-3: 0.487, 5.0e-3: 0.228, 10.0e-3: 0.099, 20.0e-3: 0.036}


def fig8(runs):
    fine = {"output.history_interval": 1.0e-5, "output.energy": "false"}
    begun = {k: [runs.start("fig8", {**fine, "time.steps_per_contact": k}, seed) for seed in GAS_MORE_SEEDS] for k in (8, 16)}
    yield
    section = Section("fig8", "energy of 300 granules in a closed box")
    n = len(GAS_SEEDS)
    section.text(f"""`io/scenes/fig8.toml`: 300 granules at 2.5 m/s in random directions, no gravity: kinetic energy (spins included) over that at
        the start, for {n} random packings, at T_c/8 and T_c/16; the same packings at both steps, but their motions part within some
        collisions. The paper prints a curve.""")
    left, curves = {}, {}
    for k in (8, 16):
        histories = [run.result().history("time", "kinetic") for run in begun[k]]
        curves[k] = (histories[0][0], numpy.array([energy / energy[0] for _, energy in histories]))
        for t in TIMES:
            left[k, t] = [numpy.interp(t, time, energy / energy[0]) for time, energy in histories]
    means = {key: Mean(values[:n]) for key, values in left.items()}
    more = {key: Mean(values) for key, values in left.items()}
    # Its deviation of 3 % is that of one of ten runs, and its three digits are rounded.
    away = {t: apart_from(more[8, t], INDEPENDENT[t], numpy.hypot(0.03 * INDEPENDENT[t] / 10 ** 0.5, 0.5e-3 / 3 ** 0.5)) for t in TIMES}
    section.table(["time, ms", "E/E0 at T_c/8", "at T_c/16", f"T_c/8, {more[8, TIMES[0]].number} packings",
                   f"T_c/16, {more[16, TIMES[0]].number} packings", "standard errors between the two", "independent", "standard errors from it"],
                  [[f"{1e3 * t:g}", means[8, t].text(4), means[16, t].text(4), f"{more[8, t].mean:.4f} ± {more[8, t].error:.4f}",
                    f"{more[16, t].mean:.4f} ± {more[16, t].error:.4f}", f"{apart(more[8, t], more[16, t]):.1f}",
                    f"{INDEPENDENT[t]:.3f} ± 3 % (10)", f"{away[t]:.1f}"] for t in TIMES])
    section.text("""In the columns of more packings the ± is the standard error of the mean; the last column is of those at T_c/8.""")
    most = max(apart(more[8, t], more[16, t]) for t in TIMES)
    section.text(f"""Between T_c/8 and T_c/16 the means lie at most {most:.1f} standard errors apart: {"no difference" if most < 3 else "a difference"}.""",
                 f"""From the independent program's the means are at most {max(away[t] for t in TIMES[:4]):.1f} standard errors away up to 10 ms. At 20 ms they are
        {away[20.0e-3]:.1f}{", a difference of " + percent(abs(more[8, 20.0e-3].mean / INDEPENDENT[20.0e-3] - 1.0)) if away[20.0e-3] > 3 else ""}: the box, the wall's
        stiffness and friction are not in the paper's text as this project knows it and are assumed (the scene says what). The oracle, from the same packings,
        agrees with the program to 0.1 % at all these times (`tests/paper/paper_test.cpp`).""")

    def draw(axes):
        for c, k in enumerate((8, 16)):
            time, energy = curves[k]
            mean, deviation = energy[:n].mean(0), energy[:n].std(0, ddof=1)
            axes.semilogy(1e3 * time[::20], mean[::20], f"C{c}{'-' if c == 0 else '--'}", linewidth=1.0, label=f"T_c/{k}, mean of {n} packings")
            if c == 0:
                axes.fill_between(1e3 * time[::20], (mean - deviation)[::20], (mean + deviation)[::20], color="C0", alpha=0.25,
                                  linewidth=0, label="deviation of one run")
        axes.plot([1e3 * t for t in TIMES], [INDEPENDENT[t] for t in TIMES], "g^", label="independent")
        axes.set_xlabel("time, ms")
        axes.set_ylabel("E / E0")
        axes.legend()

    section.picture(draw, size=(5.6, 3.4))
    for t in TIMES[:4]:
        section.bound(f"E/E0 at {1e3 * t:g} ms", means[8, t].mean, INDEPENDENT[t], 0.03)
    section.check("T_c/8 against T_c/16", most < 3.0, f"{most:.1f} standard errors", "below 3")
    off = max(abs(means[8, t].mean / INDEPENDENT[t] - 1.0) for t in TIMES[:4])
    section.verdict = f"within {percent(off)} of the independent program at 1 to 10 ms; T_c/8 is T_c/16"
    yield section

"""Fig. 8: granules in a closed box without gravity lose their energy."""

import numpy

from .page import Section, percent
from .settings import GAS_SEEDS, GAS_STEPS
from .statistics import Mean, apart, apart_from

TIMES = (1.0e-3, 2.0e-3, 5.0e-3, 10.0e-3, 20.0e-3)
INDEPENDENT = {1.0e-3: 0.685, 2.0e-3: 0.487, 5.0e-3: 0.228, 10.0e-3: 0.099, 20.0e-3: 0.036}


def fig8(runs):
    fine = {"output.history_interval": 1.0e-5, "output.energy": "false"}
    begun = {k: [runs.start("fig8", {**fine, "time.steps_per_contact": k}, seed) for seed in GAS_SEEDS] for k in GAS_STEPS}
    yield
    section = Section("fig8", "energy of 300 granules in a closed box")
    more, finest = len(GAS_SEEDS), GAS_STEPS[-1]
    section.text(f"""`io/scenes/fig8.toml`: 300 granules at 2.5 m/s in random directions, no gravity: kinetic energy (spins included) over that at
        the start, for {more} random packings, at {", ".join(f"T_c/{k}" for k in GAS_STEPS)}; the same packings at every step, but their motions
        part within some collisions. The paper prints a curve.""")
    curves, means = {}, {}
    for k in GAS_STEPS:
        histories = [run.result().history("time", "kinetic") for run in begun[k]]
        curves[k] = (histories[0][0], numpy.array([energy / energy[0] for _, energy in histories]))
        for t in TIMES:
            means[k, t] = Mean([numpy.interp(t, time, energy / energy[0]) for time, energy in histories])
    # Its deviation of 3 % is that of one of ten runs, and its three digits are rounded.
    away = {t: apart_from(means[8, t], INDEPENDENT[t], numpy.hypot(0.03 * INDEPENDENT[t] / 10 ** 0.5, 0.5e-3 / 3 ** 0.5)) for t in TIMES}
    off = {(k, t): apart(means[k, t], means[finest, t]) for k in GAS_STEPS[:-1] for t in TIMES}
    section.table(["time, ms", *(f"E/E0 at T_c/{k}" for k in GAS_STEPS),
                   *(f"T_c/{k} from T_c/{finest}, standard errors" for k in GAS_STEPS[:-1]), "independent", "T_c/8 from it, standard errors"],
                  [[f"{1e3 * t:g}", *(f"{means[k, t].mean:.4f} ± {means[k, t].error:.4f}" for k in GAS_STEPS),
                    *(f"{off[k, t]:.1f}" for k in GAS_STEPS[:-1]), f"{INDEPENDENT[t]:.3f} ± 3 % (10)", f"{away[t]:.1f}"] for t in TIMES])
    section.text(f"""The ± is the standard error of the mean of {more} packings. One packing deviates by
        {percent(min(means[8, t].deviation / means[8, t].mean for t in TIMES))} to
        {percent(max(means[8, t].deviation / means[8, t].mean for t in TIMES))} at T_c/8.""")
    most = max(off.values())
    section.text(f"""From T_c/{finest} the means lie at most {most:.1f} standard errors away: {"no difference" if most < 3 else "a difference"}.""",
                 f"""From the independent program's they are at most {max(away[t] for t in TIMES[:4]):.1f} standard errors away up to 10 ms, at 20 ms
        {away[20.0e-3]:.1f}, and always below it: the box, the wall's stiffness and friction are not in the paper's text as this project knows it and are
        assumed (the scene says what). The oracle, from the same packings, agrees with the program to 0.1 % at all these times
        (`tests/paper/paper_test.cpp`).""")

    def draw(axes):
        for c, k in enumerate((8, finest)):
            time, energy = curves[k]
            mean, deviation = energy.mean(0), energy.std(0, ddof=1)
            axes.semilogy(1e3 * time[::20], mean[::20], f"C{c}{'-' if c == 0 else '--'}", linewidth=1.0, label=f"T_c/{k}, mean of {more} packings")
            if c == 0:
                axes.fill_between(1e3 * time[::20], (mean - deviation)[::20], (mean + deviation)[::20], color="C0", alpha=0.25,
                                  linewidth=0, label="deviation of one run")
        axes.plot([1e3 * t for t in TIMES], [INDEPENDENT[t] for t in TIMES], "g^", label="independent")
        axes.set_xlabel("time, ms")
        axes.set_ylabel("E / E0")
        axes.legend()

    section.picture(draw, size=(5.6, 3.4))
    # What the independent program says of itself, and three standard errors of the mean here.
    for t in TIMES[:4]:
        allowed = round(0.03 + 3.0 * means[8, t].error / INDEPENDENT[t], 4)
        section.bound(f"E/E0 at {1e3 * t:g} ms", means[8, t].mean, INDEPENDENT[t], allowed)
    section.check(f"T_c/8 and T_c/16 against T_c/{finest}", most < 3.0, f"{most:.1f} standard errors", "below 3")
    furthest = max(abs(means[8, t].mean / INDEPENDENT[t] - 1.0) for t in TIMES[:4])
    section.verdict = f"within {percent(furthest)} of the independent program at 1 to 10 ms; T_c/8 and T_c/16 are T_c/{finest}"
    yield section

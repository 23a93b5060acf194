"""Fig. 12: Saeki's horizontal damper, rms against frequency."""

import numpy

from .page import Section, percent
from .settings import SAEKI_BARE_DURATION, SAEKI_DURATION, SAEKI_FREQUENCIES, SAEKI_SEEDS
from .statistics import Mean

MASS, STIFFNESS, DAMPING = 0.293, 1602.0, 0.117  #: of the scene, SI
NATURAL = numpy.sqrt(STIFFNESS / MASS) / (2.0 * numpy.pi)


def bare(frequency, deflection):
    """rms of the structure without granules, m."""
    w = 2.0 * numpy.pi * frequency
    return STIFFNESS * deflection / numpy.hypot(STIFFNESS - MASS * w * w, DAMPING * w) / numpy.sqrt(2.0)


def timed(deflection, frequency, duration):
    return {"excitation.static_deflection": deflection, "excitation.frequency": frequency, "output.energy": "false",
            "time.duration": duration, "output.window": f"[{0.5 * duration}, {duration}]"}


def peak(frequencies, values):
    """Place and height of the top of the parabola through the largest value and its neighbours."""
    k = int(numpy.clip(numpy.argmax(values), 1, len(values) - 2))
    a, b, c = numpy.polyfit(frequencies[k - 1:k + 2], values[k - 1:k + 2], 2)
    if a >= 0.0 or not frequencies[k - 1] <= -b / (2 * a) <= frequencies[k + 1]:
        return frequencies[k], values[k]
    return -b / (2.0 * a), c - b * b / (4.0 * a)


def fig12(runs):
    seeds = {1.0e-3: SAEKI_SEEDS, 0.5e-3: SAEKI_SEEDS[:1]}
    full = {(a, f): [runs.start("table3_saeki", timed(a, f, SAEKI_DURATION), seed) for seed in these]
            for a, these in seeds.items() for f in SAEKI_FREQUENCIES}
    alone = runs.start("table3_saeki", {**timed(1.0e-3, 11.77, SAEKI_BARE_DURATION), "granules.0.count": 0,
                                        "output.window": f"[{SAEKI_BARE_DURATION - 5.0}, {SAEKI_BARE_DURATION}]" if SAEKI_BARE_DURATION > 5 else f"[0.0, {SAEKI_BARE_DURATION}]"})
    yield
    section = Section("fig12", "Saeki's horizontal damper: rms against frequency")
    section.text(f"""`io/scenes/table3_saeki.toml`: 200 acrylic granules of 3 mm, structure of {NATURAL:.2f} Hz shaken horizontally along the box with
        a force of K a, a = 1 mm; {SAEKI_DURATION:g} s, rms over the last half, {len(SAEKI_SEEDS)} packings (a = 0.5 mm: one). The structure's mass and damping,
        the box and a are assumed (the scene says which); the paper prints curves, a peak below 11.77 Hz and nearly 90 % taken off.""")
    mean = {f: Mean(1e3 * run.result().structure["rms_displacement"] for run in full[1.0e-3, f]) for f in SAEKI_FREQUENCIES}
    half = {f: 1e3 * full[0.5e-3, f][0].result().structure["rms_displacement"] for f in SAEKI_FREQUENCIES}
    frequencies = numpy.array(SAEKI_FREQUENCIES)
    peaks = [peak(frequencies, [mean[f].values[s] for f in SAEKI_FREQUENCIES]) for s in range(len(SAEKI_SEEDS))]
    place, height = Mean(p for p, _ in peaks), Mean(h for _, h in peaks)
    at_half = peak(frequencies, [half[f] for f in SAEKI_FREQUENCIES])
    top = 1e3 * bare(NATURAL, 1.0e-3)
    section.table(["frequency, Hz", "bare (closed form), rms, mm", "200 granules, a = 1 mm, rms, mm", "a = 0.5 mm, rms, mm"],
                  [[f, f"{1e3 * bare(f, 1e-3):.2f}", mean[f].text(3), f"{half[f]:.3f}"] for f in SAEKI_FREQUENCIES])
    cut = 1.0 - height.mean / top
    cut_half = 1.0 - at_half[1] / (0.5 * top)
    resonant = 1.0 - mean[11.77].mean / (1e3 * bare(11.77, 1e-3))
    section.text(f"""Peak (parabola through the largest point and its neighbours, by packing): at **{place.text(2)} Hz**, below the bare structure's
        {NATURAL:.2f} Hz, **{height.text(2)} mm rms** high against {top:.1f} mm: {percent(cut)} taken off; with a = 0.5 mm {at_half[1]:.2f} mm at {at_half[0]:.2f} Hz,
        {percent(cut_half)}. Independent: 92 to 94 %. At 11.77 Hz itself {percent(resonant)} are taken off.""")

    def draw(axes):
        fine = numpy.linspace(10.0, 14.0, 800)
        axes.semilogy(fine, 1e3 * bare(fine, 1e-3), color="0.6", label="bare, a = 1 mm")
        axes.errorbar(frequencies, [mean[f].mean for f in SAEKI_FREQUENCIES], [3 * mean[f].error for f in SAEKI_FREQUENCIES], fmt="o-",
                      markersize=3, capsize=2, label="200 granules, a = 1 mm, 3 standard errors")
        axes.semilogy(frequencies, [half[f] for f in SAEKI_FREQUENCIES], "s--", markersize=3, linewidth=0.8, label="a = 0.5 mm, one packing")
        axes.axvline(NATURAL, color="k", linewidth=0.6, linestyle=":")
        axes.axhspan(top * 0.06, top * 0.08, color="g", alpha=0.2, label="independent: 92 to 94 % off the bare peak")
        axes.axhline(0.1 * top, color="r", linestyle="--", linewidth=0.7, label="paper: nearly 90 % off")
        axes.set_xlabel("frequency, Hz")
        axes.set_ylabel("rms displacement, mm")
        axes.legend()

    section.picture(draw, size=(6.4, 3.8))
    section.bound("bare rms at 11.77 Hz, mm, closed form", 1e3 * alone.result().structure["rms_displacement"], 1e3 * bare(11.77, 1e-3), 0.005)
    section.check("peak below the bare structure's", place.mean + 3 * (place.error if place.number > 1 else 0.0) < NATURAL, place.text(2), f"below {NATURAL:.2f} Hz")
    section.check("taken off the peak", 0.91 <= cut <= 0.95, percent(cut), "92 to 94 %, the last digit rounded")
    section.verdict = f"reproduced: peak at {place.mean:.2f} Hz, {percent(cut)} taken off (independent 92 to 94, paper nearly 90)"
    yield section

"""Granules of two sizes, from 1 : 1 to 1 : 20: cells of the small ones' size against cells of the large ones'."""

from . import peers, states
from .common import Report, in_turn, median, number, perf, quick, repeats, step_timer
from .states import START_SPEED

RATIOS = (1, 5) if quick else (1, 2, 3, 5, 10, 20)
SMALL = 2000 if quick else 20000
RADIUS = 0.5e-3
STEP = 2.0e-6


def scene(ratio):
    """As much of the large as of the small, at random, fallen to the bottom under 100 m/s^2."""
    large = max(1, round(SMALL / ratio**3)) if ratio > 1 else 0
    size = [0.04 * (SMALL / 20000) ** (1.0 / 3.0)] * 2
    size.append(2.25 * size[0])
    text = (perf / "scenes" / "S3.toml").read_text(encoding="utf-8")
    text = states.replaced(text, "[0.1, 0.1, 0.12]", str(size))
    text = states.replaced(text, "4.5e-6", str(STEP))
    name = f"radii_{ratio}_{SMALL}"
    if not (states.states / f"{name}.csv").exists():
        given = f"count   = {SMALL}\nradius  = {RADIUS}\ndensity = 1190.0"
        if large:
            given += f'\n\n[[granules]]\nname    = "large"\ncount   = {large}\nradius  = {RADIUS * ratio}\ndensity = 1190.0'
        falling = states.replaced(text, 'file    = "S3.csv"\ndensity = 1190.0', given)
        falling = states.replaced(falling, "-9.81", "-100.0")
        falling = states.replaced(falling, "amplitude = 5.0e-3", "amplitude = 0.0")
        states.end_state(falling + '\n[packing]\nkind = "random"\n', name, {"time.duration": 0.06})
        state = states.read_csv(name)
        state[:, 5] += START_SPEED
        states.write_csv(name, state)
    file = states.states / f"{name}.toml"
    file.write_text(text.replace("S3.csv", f"{name}.csv"), encoding="utf-8")
    return file


def main():
    rows = []
    steps, warm = (200, 50) if quick else (4000, 1000)
    for ratio in RATIOS:
        file = scene(ratio)
        one_level = {"verlet.cell": 1.0 + max(0.5 / ratio, 0.05)}
        taken = in_turn({"two": lambda: step_timer(file, steps=steps, warm=warm),
                         "one": lambda: step_timer(file, one_level, steps=steps, warm=warm)})
        of = taken["two"][0]
        two, one = (median([t["processor_ns_per_step"][0] for t in taken[k]]) / of["granules"] for k in ("two", "one"))
        rows.append([f"1 : {ratio}", f"{of['granules']:,}", f"{of['granules'] - SMALL:,}", number(two), number(one),
                     number(one / two), number(of["contacts_per_granule"]), number(of["candidates_per_granule"]),
                     peers.interval(of), number(of["skin_over_diameter"] * ratio)])
    report = Report("radii", "Granules of two sizes", f"""{SMALL:,} granules of {1000 * RADIUS} mm and as much volume of larger ones, a bed that begins to be shaken as S3 is.
Processor time, ns per granule and step, one thread, medians of {repeats} runs taken in turn, {steps:,} steps after {warm:,}:
as the program chooses (where two levels pay: cells of the small granules' size, large ones looked for one by one), and
with cells for the largest (`verlet.cell`).""")
    report.table(["radii", "granules", "large", "chosen", "cells for the largest", "ratio", "contacts per granule",
                  "candidates per granule", "steps per list", "skin / small diameter"], rows)
    report.write()

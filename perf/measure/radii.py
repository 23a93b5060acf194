"""Granules of unlike sizes, up to 1 : 20: cells of the small ones' size against cells of the largest ones', and LAMMPS."""

from . import peers, states
from .common import Report, have, in_turn, median, number, perf, quick, repeats, step_timer
from .states import START_SPEED

SMALL = 2000 if quick else 20000
RADIUS = 0.5e-3
STEP = 2.0e-6


def two_sizes(ratio):
    return [(1.0, SMALL)] + ([(ratio, max(1, round(SMALL / ratio**3)))] if ratio > 1 else [])


def twelve_sizes(ratio):
    factors = [ratio ** (k / 11) for k in range(12)]
    return [(factor, max(1, round(0.6 * SMALL / factor**3))) for factor in factors]


BEDS = {f"1 : {ratio}": two_sizes(ratio) for ratio in ((1, 5) if quick else (1, 2, 3, 5, 10, 20))}
WIDEST = 5 if quick else 10
BEDS[f"twelve, 1 : {WIDEST}"] = twelve_sizes(WIDEST)
SKINS = (0.2e-3,) if quick else (0.2e-3, 0.3e-3, 0.4e-3)  # of LAMMPS, to try, m


def box(sizes):
    side = 0.04 * (SMALL / 20000 * len(sizes) / 2.0) ** (1.0 / 3.0)
    return [side, side, 2.25 * side]


def scene(name, sizes):
    """As much of each size as of the others, at random, fallen to the bottom under 100 m/s^2."""
    text = (perf / "scenes" / "S3.toml").read_text(encoding="utf-8")
    text = states.replaced(text, "[0.1, 0.1, 0.12]", str(box(sizes)))
    text = states.replaced(text, "4.5e-6", str(STEP))
    if not (states.states / f"{name}.csv").exists():
        given = "\n\n[[granules]]\n".join(f'name    = "size {k}"\ncount   = {count}\nradius  = {RADIUS * factor}\ndensity = 1190.0'
                                          for k, (factor, count) in enumerate(sizes))
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


def lammps(name, sizes, steps, warm):
    """With the skin of least time, and its own cells by collections where sizes differ: one for each of two sizes, four
    for twelve."""
    known = (None, box(sizes), STEP, True, 9.81)
    data = states.write_data(name, 1, box(sizes), True)
    bounds = [2.01 * RADIUS * factor for factor, _ in (sizes if len(sizes) <= 2 else sizes[2::3])]
    cells = {"multi": 1, "collections": " ".join(map(str, [len(bounds), *bounds]))} if len(bounds) > 1 else {}

    def taken(_, skin, steps, warm):
        return peers.lammps_time(data, known, skin, steps, warm, **cells)

    skin, _ = peers.best_skin(taken, name, steps, warm, SKINS)
    return lambda: taken(name, skin, steps, warm), skin


def main():
    if not have("lmp"):
        raise SystemExit("lmp is not installed")
    rows, notes = [], []
    steps, warm = (200, 50) if quick else (4000, 1000)
    for told, sizes in BEDS.items():
        largest = sizes[-1][0]
        name = f"radii_{len(sizes)}_{largest:g}_{SMALL}"
        file = scene(name, sizes)
        one_level = {"verlet.cell": 1.0 + max(0.5 / largest, 0.05)}
        theirs, skin = lammps(name, sizes, steps, warm)
        taken = in_turn({"chosen": lambda: step_timer(file, steps=steps, warm=warm),
                         "one": lambda: step_timer(file, one_level, steps=steps, warm=warm), "LAMMPS": theirs})
        of = taken["chosen"][0]
        chosen, one = (median([t["processor_ns_per_step"][0] for t in taken[k]]) / of["granules"] for k in ("chosen", "one"))
        lammps_time = median([1000.0 * t["us"] for t in taken["LAMMPS"]]) / of["granules"]
        if any(t["dangerous"] for t in taken["LAMMPS"]):
            notes.append(f"{told}: LAMMPS reports dangerous builds.")
        rows.append([told, f"{of['granules']:,}", number(chosen), number(one), number(one / chosen),
                     number(lammps_time), f"**{lammps_time / chosen:.1f}**", f"{1e3 * skin:g}",
                     number(of["contacts_per_granule"]), number(of["candidates_per_granule"]), peers.interval(of),
                     number(of["skin_over_diameter"] * largest)])
    report = Report("radii", "Granules of unlike sizes", f"""{SMALL:,} granules of {1000 * RADIUS} mm and as much volume of larger ones; and twelve sizes, as much volume of each: a bed
that begins to be shaken as S3 is. Processor time, ns per granule and step, one thread, medians of {repeats} runs taken in turn,
{steps:,} steps after {warm:,}: as the program chooses (where two levels pay: cells of the small granules' size, large ones
looked for one by one), and with cells for the largest (`verlet.cell`). LAMMPS: its own loop time and
processor share, the skin of least time of {", ".join(f"{1e3 * skin:g}" for skin in SKINS)} mm, and its own cells by collections of sizes
(`neighbor multi`): one for each of two sizes, four for twelve.""")
    report.table(["radii", "granules", "chosen", "cells for the largest", "ratio", "LAMMPS", "LAMMPS / chosen",
                  "its skin, mm", "contacts per granule",
                  "candidates per granule", "steps per list", "skin / smallest diameter"], rows)
    for note in notes:
        report.text(note)
    report.write()

"""From 100 to 10,000,000 granules: time and memory."""

import math

from . import peers, states
from .common import Report, in_turn, median, number, perf, quick, repeats, step_timer
from .states import SCENES

SMALL = (100, 300, 1000, 3000, 10000, 30000)
#: Where memory is measured: placing these at random takes longer than timing them.
MEMORY = (10000, 100000, 1000000)
#: Copies of S3's bed side by side.
TILES = {100000: (1, 1), 300000: (3, 1), 1000000: (5, 2), 3000000: (6, 5), 10000000: (10, 10)}


def bed_text(count):
    """S3 in a box of the same shape, as much smaller or larger as the number of granules."""
    scale = (count / 100000.0) ** (1.0 / 3.0)
    box = [length * scale for length in SCENES["S3"][1]]
    return states.replaced((perf / "scenes" / "S3.toml").read_text(encoding="utf-8"), "[0.1, 0.1, 0.12]", str(box)), box


def small_bed(count):
    """Made as S3 is: a lattice, then a period of shaking."""
    text, box = bed_text(count)
    name = f"bed_{count}"
    if not (states.states / f"{name}.csv").exists():
        states.states.mkdir(parents=True, exist_ok=True)
        states.write_csv(f"{name}_lattice", states.lattice(count, SCENES["S3"][0], box))
        states.end_state(text.replace("S3.csv", f"{name}_lattice.csv"), name, {"time.duration": 1.0 / states.FREQUENCY})
    file = states.states / f"{name}.toml"
    file.write_text(text.replace("S3.csv", f"{name}.csv"), encoding="utf-8")
    return file


def memory_scene(count):
    """Granules by count: no lists of positions in the scene beside the rows."""
    text, _ = bed_text(count)
    text = states.replaced(text, 'file    = "S3.csv"', f"count   = {count}\nradius  = {SCENES['S3'][0]}")
    text += '\n[packing]\nkind = "random"\n'
    states.states.mkdir(parents=True, exist_ok=True)
    file = states.states / f"memory_{count}.toml"
    file.write_text(text, encoding="utf-8")
    return file


def main():
    rows, curve = [], []
    counts = [*SMALL, *TILES]
    if quick:
        counts = [100, 1000, 10000, 100000]
    for count in counts:
        steps = max(10, min(100000, int((2.0e6 if quick else 4.0e7) / count)))
        warm = max(5, steps // 20)
        if count in TILES:
            file, options = states.scene("S3"), {"tile": TILES[count]}
        else:
            file, options = small_bed(count), {}
        taken = in_turn({"time": lambda: step_timer(file, steps=steps, warm=warm, **options)})["time"]
        of = taken[0]
        time = median([t["processor_ns_per_step"][0] for t in taken])
        memory = step_timer(memory_scene(count), steps=3, warm=20) if count in MEMORY else None
        rows.append([f"{of['granules']:,}", number(time / 1000.0), number(time / count), number(of["contacts_per_granule"]),
                     number(of["candidates_per_granule"]), peers.interval(of),
                     number(memory["bytes_per_granule"]) if memory else "-", number(of["bytes_per_granule"]) if count >= 10000 else "-"])
        curve.append((count, time / count))
    report = Report("sizes", "From 100 to 10,000,000 granules", f"""Processor time per step of the agitated bed of S3, one thread, medians of {repeats} runs; below 100,000 granules a
smaller box of the same shape, above it copies of the bed side by side. Bytes: what the process holds more after the
steps than before the granules were placed, over the granules: first of a scene that gives granules by count (wanted:
at most 300 at 1,000,000 and above; placing 10,000,000 at random takes too long here), then of one that gives their
positions, which the simulation's two copies of the scene keep: 72 bytes each.
Wanted at 1,000,000 on AVX-512: at most 20 ns per granule-step.""")
    report.table(["granules", "us per step", "ns per granule-step", "contacts per granule", "candidates per granule",
                  "steps per list", "bytes per granule, by count", "by positions"], rows)

    def draw(axes):
        axes.loglog(*zip(*curve), "o-")
        axes.set_xlabel("granules")
        axes.set_ylabel("ns per granule-step")
        axes.set_ylim(bottom=min(t for _, t in curve) / 1.5, top=max(10 ** math.ceil(math.log10(max(t for _, t in curve))), 100))

    report.picture(draw)
    report.write()

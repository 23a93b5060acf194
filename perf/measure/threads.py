"""One scene on 1, 2, ... threads."""

import os

from . import states
from .common import Report, in_turn, median, number, quick, repeats, spread, step_timer


def main():
    cores = len(os.sched_getaffinity(0))
    counts = [n for n in (1, 2, 4, 8, 16, 32, 64) if n <= cores] or [1]
    rows = []
    for name, steps, warm, target in (("S1", 20000, 1000, None), ("S3", 1000, 60, 1.7), ("S4", 100, 20, 1.7)):
        if quick:
            steps, warm = max(steps // 20, 10), max(warm // 20, 2)
        file = states.scene(name)
        settings = {"granules.0.file": states.general(name)}
        taken = in_turn({n: lambda n=n: step_timer(file, settings, steps=steps, warm=warm, threads=n) for n in counts})
        times = {n: [t["wall_ns_per_step"][0] / 1000.0 for t in of] for n, of in taken.items()}
        wall = {n: median(of) for n, of in times.items()}
        for n in counts:
            busy = median([t["processor_ns_per_step"][0] / t["wall_ns_per_step"][0] for t in taken[n]])
            gain = wall[counts[0]] / wall[n]
            verdict = f" (at least {target}{'' if gain >= target else ': missed'})" if target and n == 2 else ""
            rows.append([name, f"{taken[n][0]['granules']:,}", n, number(wall[n]), f"{gain:.2f}{verdict}",
                         f"{min(times[counts[0]]) / min(times[n]):.2f}", f"{busy:.2f}", f"{spread(times[n]):.0f}"])
    report = Report("threads", "Threads", f"""Wall time per step, medians of {repeats} runs in turn: only to be trusted when nothing else runs. *least*: the gain by
the least times of each, which others on the machine disturb less. *busy*: processors that the process had on average;
well below the number of threads, and something else took them. Several radii possible.""")
    report.table(["scene", "granules", "threads", "us per step", "gain", "gain, least", "busy", "half range, %"], rows)
    report.write()

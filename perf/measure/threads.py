"""One scene on 1, 2, ... threads."""

import os
from concurrent.futures import ThreadPoolExecutor
from statistics import mean

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

        def timed(threads):
            return step_timer(file, settings, steps=steps, warm=warm, threads=threads)

        def at_once(runs):
            with ThreadPoolExecutor(runs) as pool:
                return list(pool.map(timed, [1] * runs))

        taken = in_turn({n: lambda n=n: timed(n) for n in counts} |
                        {("at once", n): lambda n=n: at_once(n) for n in counts[1:]})
        times = {n: [t["wall_ns_per_step"][0] / 1000.0 for t in taken[n]] for n in counts}
        wall = {n: median(of) for n, of in times.items()}
        for n in counts:
            busy = median([t["processor_ns_per_step"][0] / t["wall_ns_per_step"][0] for t in taken[n]])
            gain = wall[counts[0]] / wall[n]
            verdict = f" (at least {target}{'' if gain >= target else ': missed'})" if target and n == 2 else ""
            apart = "-"
            if n > 1:
                each = median([mean(t["wall_ns_per_step"][0] for t in runs) for runs in taken["at once", n]]) / 1000.0
                apart = f"{n * wall[counts[0]] / each:.2f}"
            least = min(times[counts[0]]) / min(times[n])
            rows.append([name, f"{taken[n][0]['granules']:,}", n, number(wall[n]), f"{gain:.2f}{verdict}", f"{least:.2f}",
                         apart, f"{busy:.2f}", f"{spread(times[n]):.0f}"])
    report = Report("threads", "Threads", f"""Wall time per step, medians of {repeats} runs in turn: only to be trusted when nothing else runs. *least*: the gain by
the least times of each, which others on the machine disturb less. *apart*: what so many runs at once, of one
thread each, get done more than one alone: more than that caches and memory do not give. *busy*: processors that the
process had on average; well below the number of threads, and something else took them. Several radii possible.""")
    report.table(["scene", "granules", "threads", "us per step", "gain", "gain, least", "apart", "busy", "half range, %"],
                 rows)
    report.write()

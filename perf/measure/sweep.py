"""A sweep of eight cases, one at a time and two at a time."""

import pathlib
import shutil
import tempfile
import time

from .common import Report, build, in_turn, median, number, perf, quick, repeats, run, spread

TARGET = 0.55  #: of the time of one at a time, at most


def sweep(at_a_time, duration):
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "sweep"
        start = time.perf_counter()
        run([build / "grandamp", "sweep", perf.parent / "io" / "scenes" / "table5.toml", "--vary", "excitation.frequency=15.5:16.5:8",
             "--set", f"time.duration={duration}", "--threads", at_a_time, "--quiet", "-o", target])
        seconds = time.perf_counter() - start
        shutil.rmtree(target)
    return seconds


def main():
    duration = 0.05 if quick else 2.0
    taken = in_turn({n: lambda n=n: sweep(n, duration) for n in (1, 2)})
    one, two = median(taken[1]), median(taken[2])
    ratio = median([b / a for a, b in zip(taken[1], taken[2])])
    report = Report("sweep", "A sweep on two cores", f"""`grandamp sweep` of Table 5's damper at 8 frequencies, {duration:g} s each, pouring included: wall time, medians of
{repeats} in turn. Each case is a process on one thread. Only to be trusted when nothing else runs.""")
    verdict = f"{ratio:.2f} (at most {TARGET}{'' if ratio <= TARGET else ': missed'})"
    report.table(["cases at a time", "s", "of one at a time", "half range, %"],
                 [[1, number(one), "1", f"{spread(taken[1]):.0f}"], [2, number(two), verdict, f"{spread(taken[2]):.0f}"]])
    report.write()

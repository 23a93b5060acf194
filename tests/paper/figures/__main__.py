"""python -m figures [NAME]...: reruns figures (all) and writes them into RESULTS.md. Status 1 if a bound is missed."""

import sys
import time

from . import contact, damping, gas, lists, page, resonance, saeki, sizes
from .runs import Runs

#: In the order of the page.
FIGURES = {"fig2": contact.fig2, "fig6": contact.fig6, "fig7": contact.fig7, "fig8": gas.fig8, "fig11": damping.fig11,
           "fig12": saeki.fig12, "fig14": lists.fig14, "table5": resonance.table5, "fig15": resonance.fig15,
           "fig16": resonance.fig16, "fig17": resonance.fig17, "size490": sizes.size490, "work": sizes.work,
           "fig18": sizes.fig18, "table6": sizes.table6}
#: The longest runs begin first.
FIRST = ("table5", "fig11")


def main(names):
    unknown = [name for name in names if name not in FIGURES]
    if unknown:
        raise SystemExit(f"no figure {', '.join(unknown)}; there are {' '.join(FIGURES)}")
    wanted = [name for name in FIGURES if name in names or not names]
    runs, begun, sections = Runs(), {}, {}
    # A figure first starts its runs and yields; when it goes on, it waits for them and yields its section.
    for name in sorted(wanted, key=lambda n: n not in FIRST):
        begun[name] = FIGURES[name](runs)
        next(begun[name])
    start = time.monotonic()
    for name in wanted:
        sections[name] = next(begun[name])
        missed = sections[name].missed()
        print(f"{name}: {'ok' if not missed else 'MISSED'} ({time.monotonic() - start:.0f} s)", flush=True)
        for what, value, allowed, _ in missed:
            print(f"  {what}: {value}, allowed {allowed}", flush=True)
    page.write(sections.values(), FIGURES)
    return 1 if any(s.missed() for s in sections.values()) else 0


sys.exit(main(sys.argv[1:]))

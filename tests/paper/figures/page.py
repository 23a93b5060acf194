"""RESULTS.md: a section by figure, with a picture, tables and bounds, and a table of all sections before them."""

import os
import pathlib
import re

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.hashsalt": "grandamp", "svg.fonttype": "none", "font.size": 9, "axes.grid": True, "grid.linewidth": 0.3,
                            "legend.fontsize": 8, "legend.framealpha": 0.9})
import matplotlib.pyplot as pyplot  # noqa: E402

from .runs import work  # noqa: E402

here = pathlib.Path(__file__).resolve().parents[1]
output = pathlib.Path(os.environ.get("GRANDAMP_PAPER_RESULTS", here))

HEAD = """# The paper, figure by figure

Source: X. Fang, J. Tang, H. Luo, "Granular damping analysis using an improved discrete element approach", J. Sound Vib. 308 (2007) 112-131.
Everything below the table was written by `bash tests/paper/run.sh`; a figure alone is made anew by `tests/paper/run.sh NAME`, with its
name from the table. Runs are those of `io/scenes/`, each by the real program on one thread, with the settings told; seeds are 1, 2, 3, ...

- **4.71 ± 0.03 (6)** is the mean of 6 runs of different seeds and the deviation of one run (not of the mean). Two means differ only if they
  are more than three standard errors apart, the deviation over the root of the number of runs.
- *Independent*: a scalar program written apart from this one, from the paper's equations with their misprints settled.
  The *oracle* is this project's own: plain scalar code that shares nothing with the solver but the scene (`tests/support/reference_run.cpp`).
- A *bound* is checked each time; `run.sh` ends with status 1 if one is missed.
- Of some figures the paper prints a curve only, or its numbers are not known to this project. Then the curve is shown for itself,
  and nothing is said to agree.

"""


class Section:
    def __init__(self, name, title):
        self.name, self.title = name, title
        self.lines, self.bounds, self.pictures = [], [], 0
        self.verdict = ""

    def text(self, *paragraphs):
        for text in paragraphs:
            self.lines += [" ".join(text.split()), ""]

    def table(self, head, rows):
        self.lines.append("| " + " | ".join(head) + " |")
        self.lines.append("|" + " --- |" * len(head))
        self.lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
        self.lines.append("")

    def bound(self, what, value, expected, tolerance, unit="", relative=True):
        """`value` within `tolerance` of `expected`; the tolerance is a share of it, or in its unit."""
        off = abs(value - expected) / (abs(expected) if relative else 1.0)
        self.check(what, off <= tolerance, f"{value:.4g}{unit}",
                   f"{expected:.4g}{unit} ± {f'{100 * tolerance:g} %' if relative else f'{tolerance:g}{unit}'}")

    def check(self, what, holds, value, allowed):
        """A bound of any kind."""
        self.bounds.append((what, value, allowed, bool(holds)))

    def picture(self, draw, columns=1, rows=1, size=(6.4, 3.6), dense=False):
        """draw(axes) fills one plot, or a row-wise list of them. `dense`: too many points for SVG."""
        figure, axes = pyplot.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
        flat = list(axes.flat)
        draw(flat if len(flat) > 1 else flat[0])
        folder = output / "pictures"
        folder.mkdir(parents=True, exist_ok=True)
        self.pictures += 1
        file = f"{self.name}{'' if self.pictures == 1 else f'_{self.pictures}'}.{'png' if dense else 'svg'}"
        figure.savefig(folder / file, **({"dpi": 75} if dense else {"metadata": {"Date": None}}))
        (work / "png").mkdir(parents=True, exist_ok=True)
        figure.savefig(work / "png" / file.replace(".svg", ".png"), dpi=100)
        pyplot.close(figure)
        self.lines += [f"![{self.title}](pictures/{file})", ""]

    def missed(self):
        return [bound for bound in self.bounds if not bound[3]]

    def body(self):
        lines = [f"## {self.name}: {self.title}", "", *self.lines]
        if self.bounds:
            lines += ["| bound | here | allowed | |", "| --- | --- | --- | --- |"]
            lines += [f"| {what} | {value} | {allowed} | {'held' if ok else '**missed**'} |"
                      for what, value, allowed, ok in self.bounds]
            lines.append("")
        return "\n".join(lines)

    def row(self):
        bounds = "none" if not self.bounds else f"{len(self.bounds) - len(self.missed())} of {len(self.bounds)} held"
        link = re.sub(r"[^\w\- ]", "", f"{self.name} {self.title}".lower()).replace(" ", "-")
        return f"| [{self.name}](#{link}) | {self.title} | {' '.join(self.verdict.split())} | {bounds} |"


def write(sections, order):
    """Sections made now replace their old selves; the others stay as they are in RESULTS.md."""
    file = output / "RESULTS.md"
    old = file.read_text(encoding="utf-8") if file.exists() else ""
    rows = {m.group(1): m.group(0) for m in re.finditer(r"^\| \[(\w+)\]\(#.*$", old, re.M)}
    bodies = {}
    for part in re.split(r"^(?=## \w+: )", old, flags=re.M)[1:]:
        bodies[re.match(r"## (\w+):", part).group(1)] = part.rstrip("\n") + "\n"
    for section in sections:
        rows[section.name], bodies[section.name] = section.row(), section.body().rstrip("\n") + "\n"
    names = [name for name in order if name in bodies and name in rows]
    text = HEAD + "| name | what | verdict | bounds |\n| --- | --- | --- | --- |\n"
    text += "\n".join(rows[name] for name in names) + "\n\n" + "\n".join(bodies[name] for name in names)
    output.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    print(f"wrote {file}")


def percent(value, digits=1):
    return f"{100.0 * value:.{digits}f} %"

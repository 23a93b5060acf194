"""What all measurements share: the programs, the machine, medians, tables and pictures."""

import datetime
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "grandamp"
matplotlib.rcParams["svg.fonttype"] = "none"
import matplotlib.pyplot as pyplot  # noqa: E402

perf = pathlib.Path(__file__).resolve().parent.parent
build = pathlib.Path(os.environ["GRANDAMP_PERF_BUILD"])
results = pathlib.Path(os.environ.get("GRANDAMP_PERF_RESULTS", perf / "results"))
repeats = int(os.environ.get("REPEATS", "3"))
#: Fewer steps and smaller cases: to see that everything works, not to measure.
quick = os.environ.get("QUICK", "0") != "0"
states = build / ("states-quick" if quick else "states")

ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1"}


def run(command, **options):
    """Standard output of a command; an error names it and shows what it said."""
    command = [str(part) for part in command]
    done = subprocess.run(command, env=ENVIRONMENT, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}\nexit status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def processor_seconds(command, folder=None):
    """Output of a command, both streams, and the processor time that it took, s."""
    command = [str(part) for part in command]
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read()
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(command)}\nexit status {process.returncode}\n{text[-2000:]}")
    return text, usage.ru_utime + usage.ru_stime


def overrides(settings):
    return [part for key, value in settings.items() for part in ("--set", f"{key}={value}")]


def step_timer(scene, settings=None, **options):
    """Times steps of a scene; options are those of perf/step_timer.cpp."""
    command = [build / "perf" / "step_timer", scene, *overrides(settings or {})]
    for name, value in options.items():
        command += [f"--{name}", *(value if isinstance(value, (list, tuple)) else [value])]
    return json.loads(run(command))


def in_turn(measurements):
    """Takes each measurement in turn, `repeats` times over: {name: list of results}."""
    taken = {name: [] for name in measurements}
    for _ in range(repeats):
        for name, measure in measurements.items():
            taken[name].append(measure())
    return taken


def median(values):
    return statistics.median(values)


def spread(values):
    """Half the range over the median, in percent."""
    middle = statistics.median(values)
    return 50.0 * (max(values) - min(values)) / middle if middle else 0.0


def processor_name():
    for line in open("/proc/cpuinfo", encoding="utf-8"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def instruction_sets():
    flags = next((line for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("flags")), "").split()
    sets = ["generic"]
    if "avx2" in flags and "fma" in flags:
        sets.append("avx2")
    if all(f in flags for f in ("avx512f", "avx512dq", "avx512vl", "avx512bw")):
        sets.append("avx512")
    return sets


def machine():
    cache = pathlib.Path("/sys/devices/system/cpu/cpu0/cache")
    sizes = [f"L{(i / 'level').read_text().strip()} {(i / 'size').read_text().strip()}"
             for i in sorted(cache.glob("index*")) if (i / "type").read_text().strip() != "Instruction"]
    compiler = run(["c++", "--version"]).splitlines()[0]
    commit = subprocess.run(["git", "-C", str(perf), "describe", "--always", "--dirty"], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout.strip() or "unknown"
    return {"processor": f"{processor_name()}, {os.cpu_count()} cores, {', '.join(sizes)}",
            "instruction sets": ", ".join(instruction_sets()),
            "compiler": compiler,
            "commit": commit,
            "load when begun": f"{os.getloadavg()[0]:.2f}",
            "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")}


class Report:
    """A page of results/: what was asked, where, when, then tables and pictures."""

    def __init__(self, name, title, how):
        self.name = name
        results.mkdir(parents=True, exist_ok=True)
        self.lines = [f"# {title}", "", f"`perf/run.sh {name}`, REPEATS={repeats}" + (", QUICK: not to be quoted" if quick else ""), ""]
        self.lines += [f"- {key}: {value}" for key, value in machine().items()]
        self.lines += ["", how, ""]

    def text(self, text):
        self.lines += [text, ""]

    def table(self, head, rows, title=None):
        if title:
            self.lines += [f"## {title}", ""]
        self.lines.append("| " + " | ".join(head) + " |")
        self.lines.append("|" + " --- |" * len(head))
        self.lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
        self.lines.append("")

    def picture(self, draw, suffix="", size=(6.4, 4.2)):
        """draw(axes) fills one plot."""
        figure, axes = pyplot.subplots(figsize=size)
        draw(axes)
        axes.grid(True, which="both", linewidth=0.3)
        figure.tight_layout()
        file = f"{self.name}{suffix}.svg"
        figure.savefig(results / file, metadata={"Date": None})
        pyplot.close(figure)
        self.lines += [f"![{self.name}]({file})", ""]

    def write(self):
        file = results / f"{self.name}.md"
        file.write_text("\n".join(self.lines).rstrip() + "\n", encoding="utf-8")
        print(f"wrote {file}")


def number(value, digits=3):
    if value is None:
        return "-"
    return f"{value:.{digits}g}" if abs(value) < 1000 else f"{value:,.0f}"


def have(program):
    return shutil.which(program) is not None


def found(pattern, text):
    match = re.search(pattern, text)
    if not match:
        raise SystemExit(f"nothing like {pattern!r} in:\n{text[-2000:]}")
    return match.groups()

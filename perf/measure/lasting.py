"""What long runs cost beside their steps: checkpoints, and memory and rate as time goes."""

import json
import os
import pty
import re
import shutil
import subprocess
import tempfile
import time

from . import sizes
from .common import ENVIRONMENT, Report, build, in_turn, median, number, overrides, perf, quick, spread, states

TABLE_5 = perf.parent / "io" / "scenes" / "table5.toml"
EVERY = 60.0  # s: the default of output.checkpoint_interval


def disk_speed(size, folder):
    """Bytes per second of plain writing and syncing of as many bytes."""
    block = os.urandom(1 << 20)
    with tempfile.NamedTemporaryFile(dir=folder) as file:
        begun = time.monotonic()
        for _ in range(max(1, -(-size // len(block)))):
            file.write(block[:min(size, len(block))])
        file.flush()
        os.fsync(file.fileno())
        return file.tell() / (time.monotonic() - begun)


def with_checkpoints(scene, settings, interval):
    """One run: seconds from t = 0, those of its output, checkpoints written while it ran, and the size of one."""
    folder = states / "checkpointed"
    settings = {**settings, "output.checkpoint_interval": interval}
    command = [build / "grandamp", "run", scene, "-o", folder, "--force", "--quiet", "--threads", "1", "--profile",
               *overrides(settings)]
    process = subprocess.Popen([str(part) for part in command], env=ENVIRONMENT)
    seen, file = set(), folder / "checkpoint.h5"
    while process.poll() is None:
        try:
            there = file.stat()
            seen.add((there.st_ino, there.st_mtime_ns))
        except FileNotFoundError:
            pass
        time.sleep(0.002)
    if process.returncode != 0:
        raise SystemExit(f"{command} ended with {process.returncode}")
    summary = json.loads((folder / "summary.json").read_text())
    result = {"wall": summary["wall_time"], "output": summary["profile"]["output"], "granules": summary["granules"],
              "checkpoints": len(seen), "size": file.stat().st_size if interval else 0}
    shutil.rmtree(folder)
    return result


def checkpoint():
    states.mkdir(parents=True, exist_ok=True)
    step = 4.5e-6  # of the beds
    cases = [("Table 5", TABLE_5, {"time.duration": 0.5 if quick else 10.0}, 0.1 if quick else 0.25)]
    for count, steps in ((10000, 500),) if quick else ((100000, 4000), (1000000, 1200)):
        # A closing speed far above what shaking makes: granules placed at random are thrown about at first.
        cases.append((f"bed of {count:,}", sizes.memory_scene(count), {"time.duration": steps * step},
                      0.2 if quick else max(1.0, 4.0e-6 * count)))
    name, scene, settings, interval = cases[-1]
    cases.append((f"{name}, energy ledger on", scene, {**settings, "output.energy": "true"}, interval))
    rows = []
    for name, scene, settings, interval in cases:
        taken = in_turn({"with": lambda: with_checkpoints(scene, settings, interval),
                         "without": lambda: with_checkpoints(scene, settings, 0)})
        of = taken["with"][0]
        each = [(a["output"] - b["output"]) / a["checkpoints"] for a, b in zip(taken["with"], taken["without"])]
        whole = [(a["wall"] - b["wall"]) / a["checkpoints"] for a, b in zip(taken["with"], taken["without"])]
        seconds = median(each)
        disk = median([disk_speed(of["size"], states) for _ in range(5)])
        rows.append([name, of["checkpoints"], number(of["size"] / 1e6), number(of["size"] / of["granules"]), number(1e3 * seconds),
                     f"{spread(each):.0f} %", number(1e3 * median(whole)), number(1e3 * of["size"] / disk), number(disk / 1e6),
                     f"{100.0 * seconds / EVERY:.3f} %"])
    report = Report("checkpoint", "What a checkpoint costs", f"""Runs with a checkpoint every so often and without any, in turn, one thread. Milliseconds per checkpoint: by
what the run's profile counts as output (its state taken, the logs synced, the file written, digested, synced and renamed), with half the range
over the runs; then by all wall time of the two runs, which also has their noise. The disk alone: as many bytes
written and synced by a plain program, in the same folder. Share: of a run with a checkpoint every {EVERY:g} s.
Wanted: below 1 %.""")
    report.table(["run", "checkpoints", "MB each", "bytes per granule", "ms each", "+-", "ms each, by wall time",
                  "the disk alone, ms", "the disk, MB/s", f"share, every {EVERY:g} s"], rows)
    report.write()


def resident(pid):
    with open(f"/proc/{pid}/status", encoding="utf-8") as status:
        for line in status:
            if line.startswith("VmRSS"):
                return int(line.split()[1]) * 1024
    return 0


def looked_at(command, duration):
    """(simulated s, wall s, bytes resident) as the progress line of a run tells them, about ten times a second."""
    terminal, end = pty.openpty()
    process = subprocess.Popen([str(part) for part in command], env=ENVIRONMENT, stderr=end)
    os.close(end)
    text, looks, begun = "", [], time.monotonic()
    while True:
        try:
            got = os.read(terminal, 65536).decode()
        except OSError:  # the program closed it
            break
        *lines, text = (text + got).split("\r")
        for line in lines:
            shown = re.match(r"([0-9.e+-]+) of [0-9.e+-]+ s \(", line)
            if shown:
                try:
                    looks.append((float(shown.group(1)), time.monotonic() - begun, resident(process.pid)))
                except (FileNotFoundError, ProcessLookupError):
                    pass
    os.close(terminal)
    if process.wait() != 0:
        raise SystemExit(f"{command} ended with {process.returncode}")
    return [look for look in looks if look[0] < duration and look[2] > 0]


def long_run():
    states.mkdir(parents=True, exist_ok=True)
    duration = 4.0 if quick else 60.0
    folder = states / "long"
    settings = {"time.duration": duration, "output.window": f"[{0.5 * duration},{duration}]", "output.snapshot_interval": 0.05,
                "output.checkpoint_interval": 5}
    looks = looked_at([build / "grandamp", "run", TABLE_5, "-o", folder, "--force", "--threads", "1", *overrides(settings)],
                      duration)
    summary = json.loads((folder / "summary.json").read_text())
    results = sum((folder / name).stat().st_size for name in ("results.h5",))
    shutil.rmtree(folder)
    work = summary["granules"] * summary["steps"]
    rows = []
    for quarter in range(4):
        part = [look for look in looks if quarter * duration / 4 <= look[0] < (quarter + 1) * duration / 4]
        if len(part) < 3:
            raise SystemExit("the progress line came too seldom to tell quarters apart")
        rate = (part[-1][0] - part[0][0]) / duration * work / (part[-1][1] - part[0][1])
        memory = [look[2] for look in part]
        rows.append([quarter + 1, number(rate / 1e6), number(min(memory) / 1e6, 4), number(max(memory) / 1e6, 4)])
    report = Report("long_run", "Memory and rate as time goes", f"""Table 5's damper for {duration:g} s, {number(work)} granule-steps, one thread, with the ledger, a snapshot every 50 ms and a
checkpoint every 5 s; results.h5 came to {number(results / 1e6)} MB. By quarters of the simulated time: the rate, all writing included, and the
resident memory, least and most. The damper comes from rest, so the first quarter holds its transient.""")
    report.table(["quarter", "million granule-steps per second", "resident, MB, least", "most"], rows)
    report.write()

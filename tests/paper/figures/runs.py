"""Runs of the program, on all cores, and what they left behind."""

import concurrent.futures
import csv
import hashlib
import json
import os
import pathlib
import shutil
import subprocess

import numpy

root = pathlib.Path(__file__).resolve().parents[3]
scenes = root / "io" / "scenes"
build = root / "build"
program = build / "grandamp"
oracle = build / "tests" / "reference_program"
work = build / "paper"

#: Histories are few rows unless a figure is made of them; a run that is killed is run again, so nothing is kept of it.
USUAL = {"output.history_interval": 0.01, "output.checkpoint_interval": 0.0}


class Run:
    """The folder of a finished run."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        self.structure = self.summary.get("structure", {})
        self.energy = self.summary.get("energy", {})

    def history(self, *names):
        """Arrays of the histories of these names."""
        import h5py
        with h5py.File(self.folder / "results.h5") as results:
            return [results["/history/" + name][:] for name in names]

    def snapshots(self):
        """Times (T), positions and velocities (T x n x 3) of the snapshots."""
        import h5py
        with h5py.File(self.folder / "results.h5") as results:
            times = results["/snapshots/time"][:]
            groups = [results[f"/snapshots/{k:06d}"] for k in range(len(times))]
            return times, numpy.array([g["position"] for g in groups]), numpy.array([g["velocity"] for g in groups])

    def end(self):
        """Positions and velocities at the end, n x 3."""
        import h5py
        with h5py.File(self.folder / "results.h5") as results:
            return results["/final/position"][:], results["/final/velocity"][:]


class Runs:
    """Starts runs, one process each; the same program, scene and settings are run once, and kept in build/paper/runs."""

    def __init__(self):
        self.pool = concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", os.cpu_count() or 1)))
        self.digest = {file: hashlib.sha256(file.read_bytes()) for file in (program, oracle)}
        self.begun = {}

    def folder(self, by, text, settings):
        digest = self.digest[by].copy()
        digest.update(json.dumps([text, settings], sort_keys=True).encode())
        return work / "runs" / digest.hexdigest()[:24]

    def submit(self, folder, call):
        if folder not in self.begun:
            self.begun[folder] = self.pool.submit(call)
        return self.begun[folder]

    def start(self, scene, settings=None, seed=1, may_stop=False):
        """Future of a Run: `scene` is a file of io/scenes, a path, or a scene's text. `may_stop`: a guard may end it."""
        settings = {**USUAL, "seed": seed, **(settings or {})}
        file = scenes / f"{scene}.toml" if isinstance(scene, str) and "\n" not in scene else scene
        text = file if isinstance(file, str) else file.read_text(encoding="utf-8")
        folder = self.folder(program, text, settings)

        def call():
            if (folder / "summary.json").exists():
                done = Run(folder)
                if done.summary["status"] == "done" or may_stop:
                    return done
            shutil.rmtree(folder, ignore_errors=True)
            folder.parent.mkdir(parents=True, exist_ok=True)
            path = folder.with_suffix(".toml")
            path.write_text(text, encoding="utf-8")
            overrides = [part for key, value in settings.items() for part in ("--set", f"{key}={value}")]
            command([program, "run", path, "-o", folder, "--threads", 1, "--quiet", "--force", *overrides],
                    (0, 3) if may_stop else (0,))
            return Run(folder)

        return self.submit(folder, call)

    def start_oracle(self, scene, settings, seed=1):
        """Future of the scalar oracle's history: dict of arrays time, displacement, velocity."""
        settings = {"output.history_interval": 1.0e-4, "seed": seed, **settings}
        file = scenes / f"{scene}.toml"
        folder = self.folder(oracle, file.read_text(encoding="utf-8"), settings)

        def call():
            table = folder / "history.csv"
            if not table.exists():
                folder.mkdir(parents=True, exist_ok=True)
                part = folder / "history.part"
                said = command([oracle, file, part, *(f"{key}={value}" for key, value in settings.items())])
                (folder / "said.txt").write_text(said, encoding="utf-8")
                part.rename(table)
            with open(table, encoding="utf-8") as lines:
                rows = list(csv.DictReader(lines))
            return {name: numpy.array([float(row[name]) for row in rows]) for name in rows[0]}

        return self.submit(folder, call)


def command(arguments, allowed=(0,)):
    arguments = [str(part) for part in arguments]
    done = subprocess.run(arguments, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=root)
    if done.returncode not in allowed:
        raise RuntimeError(f"{' '.join(arguments)}\nexit status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def response(time, displacement, frequency, window):
    """Amplitude and rms as the program's summary has them, from a history fine enough: m."""
    period = 1.0 / frequency
    inside = (time >= window[0]) & (time <= window[1])
    whole = int((window[1] - window[0]) / period + 1e-9)
    starts = window[0] + period * numpy.arange(whole + 1)
    swings = [displacement[(time >= a) & (time < b)] for a, b in zip(starts, starts[1:])]
    return numpy.mean([0.5 * (s.max() - s.min()) for s in swings]), numpy.sqrt(numpy.mean(displacement[inside] ** 2))

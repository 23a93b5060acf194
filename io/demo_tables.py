#!/usr/bin/env python3
"""demo_tables.py FOLDER: what the demo's two runs, FOLDER/without and FOLDER/with, gave, beside what is known.

Amplitudes beside the paper's and an independent program's; the energy ledger, its balance worked out again from the
terms in summary.json; rate and wall time. Exit status 1 if an amplitude or a balance is off.
"""
import json
import pathlib
import sys

# Amplitude at resonance, m: Fang et al. 2007, an independent scalar program, and how far from the latter is right.
REFERENCES = {"without": (24.76e-3, 24.79e-3, 0.01), "with": (4.63e-3, 4.68e-3, 0.04)}
GREATEST_RESIDUAL = 0.01
STORED = ("kinetic", "gravitational", "elastic", "structure")
LOSSES = ("structural_damping", "normal_granule", "normal_wall", "friction_granule", "friction_wall")


def balance(energy):
    """What is left of initial + work in = stored + losses, over the largest of |work in| and the initial energies."""
    initial = sum(energy["initial"][name] for name in STORED)
    rest = initial + energy["work_in"] - sum(energy[name] for name in STORED + LOSSES)
    scale = max(abs(energy["work_in"]), sum(energy["initial"][name] for name in ("kinetic", "elastic", "structure")))
    return rest / scale


def main():
    folder = pathlib.Path(sys.argv[1])
    runs = {name: json.loads((folder / name / "summary.json").read_text()) for name in REFERENCES}
    wrong = []

    print(f"{'amplitude, mm':26}{'here':>12}{'paper':>12}{'independent':>14}{'off by':>10}")
    for name, (paper, independent, tolerance) in REFERENCES.items():
        structure = runs[name]["structure"]
        off = structure["amplitude"] / independent - 1.0
        label = f"{name} granules ({runs[name]['granules']})"
        print(f"{label:26}{1e3 * structure['amplitude']:12.3f}{1e3 * paper:12.2f}{1e3 * independent:14.2f}{off:10.1%}")
        if not abs(off) <= tolerance:
            wrong.append(f"{name} granules: the amplitude is {off:.1%} off, {tolerance:.0%} is allowed")
    ratio = runs["with"]["structure"]["amplitude"] / runs["without"]["structure"]["amplitude"]
    print(f"The granules take {1.0 - ratio:.1%} off.\n")

    print(f"{'energy, J':26}" + "".join(f"{name + ' granules':>20}" for name in runs))

    def row(label, value):
        print(f"{label:26}" + "".join(f"{value(run['energy']):20.6f}" for run in runs.values()))

    for name in STORED:
        row(f"initial {name}", lambda energy: energy["initial"][name])
    row("+ work_in", lambda energy: energy["work_in"])
    for name in LOSSES:
        row(f"- {name}", lambda energy: energy[name])
    for name in STORED:
        row(f"- final {name}", lambda energy: energy[name])
    print(f"{'= left over, of the scale':26}" + "".join(f"{balance(run['energy']):20.2e}" for run in runs.values()))
    row("  as the summary has it", lambda energy: energy["residual"])
    for name, run in runs.items():
        if not abs(balance(run["energy"])) <= GREATEST_RESIDUAL:
            wrong.append(f"{name} granules: the energies do not balance within {GREATEST_RESIDUAL:.0%}")

    run = runs["with"]
    print(f"\n{run['granules']} granules, {run['steps']} steps of {run['time_step']:.3e} s on {run['threads']} thread(s), "
          f"{run['isa']}: {run['wall_time']:.1f} s, {1e-6 * run['granule_steps_per_second']:.1f} million granule-steps "
          f"per second")
    print(f"Picture: {folder / 'histories.png'}")
    for text in wrong:
        print(f"WRONG: {text}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

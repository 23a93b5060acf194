"""S1 to S5 in turn with LAMMPS and LIGGGHTS, from the same start states."""

import math
import os
import tempfile

from . import states
from .common import (Report, build, found, have, in_turn, median, number, overrides, perf, processor_seconds, quick,
                     repeats, spread, step_timer)
from .states import SCENES, START_SPEED

#: steps timed, steps before that, LAMMPS's skins to try (m), least ratio wanted to LAMMPS, and to LIGGGHTS
PLAN = {
    "S1": (20000, 1000, (0.3e-3, 0.4e-3, 0.5e-3, 0.6e-3), 9.0, 11.0),
    "S1_rest": (20000, 1000, (0.1e-3, 0.2e-3, 0.3e-3), None, None),
    "S2": (20000, 1000, (0.35e-3, 0.45e-3, 0.6e-3), None, None),
    "S3": (400, 40, (0.08e-3, 0.12e-3, 0.16e-3, 0.24e-3), 8.0, None),
    "S4": (100, 20, (0.08e-3, 0.12e-3, 0.16e-3, 0.24e-3), 9.0, None),
    "S5": (40000, 1000, (0.4e-3, 0.5e-3, 0.8e-3, 1.2e-3), 5.0, None),
}

#: All, or those of the environment's SCENES ("S1 S5").
SCENE_NAMES = os.environ.get("SCENES", " ".join(PLAN)).split()


def plan(name):
    steps, warm, skins, target, liggghts_target = PLAN[name]
    if quick:
        steps, warm, skins = max(steps // 20, 10), max(warm // 20, 2), skins[1:2]
    return steps, warm, skins, target, liggghts_target


def peer(program, deck, data, scene, skin, steps, warm, every=5, **others):
    """Runs a peer on a scene as SCENES has it; its output and the process's own processor time, s."""
    radius, box, time_step, shaken, gravity = scene
    values = {"data": data, "step": time_step, "box_x": box[0], "box_y": box[1], "box_z": box[2], "skin": skin,
              "every": every, "warm": warm, "steps": steps, "gravity": gravity, "shaken": int(shaken), **others}
    command = [program, "-in", str(deck), "-log", "none"]
    for key, value in values.items():
        command += ["-var", key, str(value)]
    with tempfile.TemporaryDirectory() as folder:
        return processor_seconds(command, folder)


def lammps(name, skin, steps, warm):
    """Microseconds of processor time per step: LAMMPS's own loop time and its share of the processor in it."""
    return lammps_time(states.data_file(name, 1), SCENES[name], skin, steps, warm)


def lammps_time(data, scene, skin, steps, warm, **others):
    text, _ = peer("lmp", perf / "peers" / "shaken_box.lammps", data, scene, skin, steps, warm, **others)
    timed = text[text.rindex("Loop time"):]
    seconds, done = found(r"Loop time of (\S+) on 1 procs for (\d+) steps", timed)
    (share,) = found(r"([\d.]+)% CPU use", timed)
    builds, = found(r"Neighbor list builds = (\d+)", timed)
    dangerous, = found(r"Dangerous builds = (\d+)", timed)
    if int(done) != steps:
        raise SystemExit(f"LAMMPS: {done} steps instead of {steps}")
    return {"us": 1e6 * float(seconds) * min(1.0, float(share) / 100.0) / steps, "builds": int(builds),
            "dangerous": int(dangerous)}


def liggghts(name, skin, steps, warm):
    """It tells no share of the processor: the process's time less that of a run that only warms up."""
    deck, data = perf / "peers" / "shaken_box.liggghts", states.data_file(name, 2)
    _, whole = peer("liggghts", deck, data, SCENES[name], skin, steps, warm)
    _, start = peer("liggghts", deck, data, SCENES[name], skin, 0, warm)
    return {"us": 1e6 * (whole - start) / steps}


def coupled(name):
    """The enclosure carried by a structure that a force drives through the motion that is prescribed otherwise."""
    if not SCENES[name][3]:
        return {}
    omega = START_SPEED / 5.0e-3
    radius = SCENES[name][0]
    count = sum(1 for _ in open(states.states / f"{name}.csv", encoding="utf-8")) - 1
    mass = 100.0 * count * states.DENSITY * 4.0 / 3.0 * math.pi * radius**3
    return {"structure.mass": mass, "structure.stiffness": 4.0 * mass * omega**2, "structure.damping": 0.0,
            "structure.direction": "[1, 0, 0]", "structure.velocity": START_SPEED, "excitation.kind": "harmonic",
            "excitation.static_deflection": 0.75 * 5.0e-3}


def settings_of(name, variant):
    """Variants: as the program chooses for the scene; general, with several radii possible and the structure coupled;
    and that with the ledger."""
    if variant == "chosen":
        return {}
    return {"granules.0.file": states.general(name), **coupled(name)} | (
        {"output.energy": "true"} if variant == "ledger" else {})


def ours(name, variant, steps, warm):
    return step_timer(states.scene(name), settings_of(name, variant), steps=steps, warm=warm)


def program(name, steps, warm):
    """The whole program, history and all: its time less that of a run that only warms up."""
    def seconds(count):
        settings = settings_of(name, "general") | {"time.duration": f"{count * SCENES[name][2]:.12g}"}
        with tempfile.TemporaryDirectory() as folder:
            return processor_seconds([build / "grandamp", "run", states.scene(name), "-o", f"{folder}/run", "--quiet",
                                      "--threads", 1, *overrides(settings)])[1]
    return {"us": 1e6 * (seconds(warm + steps) - seconds(warm)) / steps}


def microseconds(timing):
    return median(timing["processor_ns_per_step"]) / 1000.0


def best_skin(program, name, steps, warm, skins):
    """The skin of least time, each tried once over a shorter run."""
    tried = {skin: program(name, skin, max(steps // 4, 5), warm)["us"] for skin in skins}
    return min(tried, key=tried.get), tried


def measure(report_name, title, names, peers):
    rows, skins_tried, notes = [], [], []
    for name in names:
        steps, warm, skins, target, liggghts_target = plan(name)
        states.scene(name)
        measurements = {}
        if "lammps" in peers:
            skin, tried = best_skin(lammps, name, steps, warm, skins)
            skins_tried.append((name, "LAMMPS", *scan(tried, skin)))
            measurements["LAMMPS"] = lambda skin=skin: lammps(name, skin, steps, warm)
        measurements["general"] = lambda: ours(name, "general", steps, warm)
        if "liggghts" in peers and name in ("S1", "S2", "S3", "S5"):
            liggghts_skin, tried = best_skin(liggghts, name, steps, warm, skins)
            skins_tried.append((name, "LIGGGHTS", *scan(tried, liggghts_skin)))
            measurements["LIGGGHTS"] = lambda skin=liggghts_skin: liggghts(name, skin, steps, warm)
        measurements["chosen"] = lambda: ours(name, "chosen", steps, warm)
        if name != "S4":  # whose start takes longer than its steps
            measurements["program"] = lambda: program(name, steps, warm)
        measurements["ledger"] = lambda: ours(name, "ledger", steps, warm)
        taken = in_turn(measurements)
        times = {key: [t["us"] if "us" in t else microseconds(t) for t in value] for key, value in taken.items()}
        time_of = {key: median(value) for key, value in times.items()}
        spreads = {key: spread(value) for key, value in times.items()}
        general = taken["general"][-1]
        if taken.get("LAMMPS") and any(t["dangerous"] for t in taken["LAMMPS"]):
            notes.append(f"{name}: LAMMPS reports dangerous builds")

        def ratio(key, wanted):
            if key not in time_of:
                return "-"
            value = time_of[key] / time_of["general"]
            return f"**{value:.1f}**" + (f" (at least {wanted:g}{'' if value >= wanted else ': missed'})" if wanted else "")

        def ratio_of_least(key):
            return f"{min(times[key]) / min(times['general']):.1f}" if key in times else "-"

        rows.append([name, f"{general['granules']:,}", number(time_of.get("LAMMPS")),
                     number(time_of.get("LIGGGHTS")), number(time_of["general"]), number(time_of.get("program")),
                     number(time_of["chosen"]), number(time_of["ledger"]), ratio("LAMMPS", target),
                     ratio("LIGGGHTS", liggghts_target), ratio_of_least("LAMMPS"), ratio_of_least("LIGGGHTS"),
                     number(1000.0 * time_of["general"] / general["granules"]),
                     number(general["contacts_per_granule"]), number(general["candidates_per_granule"]),
                     interval(general), number(general["skin_over_diameter"], 2),
                     ", ".join(f"{key} {value:.0f}" for key, value in spreads.items())])
    report = Report(report_name, title, f"""Microseconds of processor time per step, one thread ({general['isa']}), medians of {repeats} runs taken in turn
(A B C A B C ...) from the same start state. LAMMPS: its own loop time and processor share; LIGGGHTS: the process's
time less that of a run without the timed steps; ours: the process's clock around the steps (perf/step_timer.cpp).
*general*: several radii possible, structure coupled where the scene shakes, ledger off: what the ratios are taken of.
*program*: the same through `grandamp run` with its files and its history row every 0.1 ms, measured as LIGGGHTS is.
*chosen*: the kernels that the program chooses by itself for this scene (one radius). *ledger*: general, with the
energy ledger. *least*: the same ratios of the least times of each instead of the medians, which others on the machine
disturb less. The targets were set for a machine with AVX-512.""")
    report.table(["scene", "granules", "LAMMPS", "LIGGGHTS", "general", "program", "chosen", "ledger", "LAMMPS / general",
                  "LIGGGHTS / general", "LAMMPS, least", "LIGGGHTS, least", "ns per granule-step",
                  "contacts per granule", "candidates per granule", "steps per list", "skin / d", "half range, %"], rows)
    if skins_tried:
        report.table(["scene", "program", "skins tried, mm", "us per step", "taken"], skins_tried, "Skins of the others")
    for note in notes:
        report.text(note)
    report.write()


def interval(timing):
    return number(timing["mean_interval"]) if timing["builds"] else f"over {timing['steps']:,}"


def scan(tried, skin):
    return (", ".join(f"{1e3 * s:g}" for s in tried), ", ".join(number(t) for t in tried.values()), f"{1e3 * skin:g}")


def main():
    for program in ("lmp", "liggghts"):
        if not have(program):
            raise SystemExit(f"{program} is not installed")
    measure("peers", "Against LAMMPS and LIGGGHTS", SCENE_NAMES, {"lammps", "liggghts"})


def scenes():
    measure("scenes", "The five scenes", SCENE_NAMES, set())


if __name__ == "__main__":
    main()

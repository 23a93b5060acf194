"""Start states of S1 to S5, shared by all programs: positions, velocities and spins, from our own program.

NAME.csv is in the frames of a scene file (velocities in the laboratory's). For LAMMPS and LIGGGHTS, whose box stands
still, the enclosure's velocity at the start is taken off."""

import math
import shutil

import numpy as np

from .common import build, overrides, perf, quick, run, states

SCENES = {  # name: radius, box, time step, shaken, gravity
    "S1": (1.0e-3, (0.025, 0.025, 0.0359), 4.5e-6, True, 9.81),
    "S1_rest": (1.0e-3, (0.025, 0.025, 0.0359), 4.5e-6, False, 9.81),
    "S2": (1.17e-3, (0.025, 0.025, 0.0359), 5.265e-6, True, 9.81),
    "S3": (1.0e-3, (0.1, 0.1, 0.12), 4.5e-6, True, 9.81),
    "S4": (1.0e-3, (0.2, 0.2, 0.28), 4.5e-6, True, 9.81),
    "S5": (1.5e-3, (0.025, 0.025, 0.0359), 5.06e-6, False, 0.0),
}
DENSITY = 1190.0
FREQUENCY = 15.9
START_SPEED = 5.0e-3 * 2.0 * math.pi * FREQUENCY  # of a shaken enclosure at t = 0, m/s
COLUMNS = "id,x,y,z,radius,vx,vy,vz,wx,wy,wz"


def scene(name):
    """The scene file of a name, beside its start state."""
    states.mkdir(parents=True, exist_ok=True)
    target = states / f"{name}.toml"
    shutil.copyfile(perf / "scenes" / f"{name}.toml", target)
    if not (states / f"{name}.csv").exists():
        make(name)
    return target


def end_state(text, name, settings=None):
    """Runs a scene, exports its granules to NAME.csv."""
    states.mkdir(parents=True, exist_ok=True)
    file, folder, state = states / f"{name}_start.toml", states / f"{name}_start", states / f"{name}.csv"
    file.write_text(text, encoding="utf-8")
    program = build / "grandamp"
    run([program, "run", file, "-o", folder, "--force", "--quiet", *overrides(settings or {})])
    run([program, "export", folder, "granules", "-o", str(state) + ".part"])
    shutil.move(str(state) + ".part", state)
    shutil.rmtree(folder)
    return state


def by_count(name, count, packing, more=""):
    text = (perf / "scenes" / f"{name}.toml").read_text(encoding="utf-8")
    given = f"count   = {count}\nradius  = {SCENES[name][0]}{more}"
    return replaced(text, f'file    = "{name}.csv"', given) + f'\n[packing]\nkind = "{packing}"\n'


def replaced(text, old, new):
    if old not in text:
        raise SystemExit(f"a scene of perf/scenes lacks {old!r}")
    return text.replace(old, new)


def make(name):
    period = 1.0 / FREQUENCY
    if name == "S1":
        end_state(by_count(name, 2007, "settled"), name, {"time.duration": 2.0 * period})
    elif name == "S1_rest":
        end_state(by_count(name, 2007, "settled"), name, {"time.duration": 9.0e-6})
    elif name == "S2":
        end_state(by_count(name, 1246, "settled"), name, {"time.duration": 2.0 * period})
    elif name == "S5":
        end_state(by_count(name, 300, "random", "\nspeed   = 2.5"), name, {"time.duration": 1.1e-5})
    elif name == "S3":
        write_csv("S3_lattice", lattice(100000, 1.0e-3, SCENES["S3"][1]))
        text = (perf / "scenes" / "S3.toml").read_text(encoding="utf-8").replace("S3.csv", "S3_lattice.csv")
        end_state(text, name, {"time.duration": (0.1 if quick else 1.0) * period})
    elif name == "S4":
        scene("S3")
        write_csv("S4", tiled(read_csv("S3"), SCENES["S3"][1], 1.0e-3))


def lattice(count, radius, box):
    """Layers of squares, every other one moved by half a place: loose enough to be shaken apart at once."""
    pitch, margin = 2.06 * radius, 1.01 * radius
    across = [int((length - 2.0 * margin) / pitch + 0.5) for length in box[:2]]
    step = [(length - 2.0 * margin) / (n - 0.5) for length, n in zip(box, across)]
    # Clear of the layer below, and of the one below that.
    height = max(1.02 * math.sqrt(max(0.0, 4.0 * radius**2 - (step[0] ** 2 + step[1] ** 2) / 4.0)), 1.03 * radius)
    layers = -(-count // (across[0] * across[1]))
    z, y, x = np.meshgrid(np.arange(layers), np.arange(across[1]), np.arange(across[0]), indexing="ij")
    places = np.stack([c.ravel() for c in (x, y, z)], 1)[:count].astype(float)
    odd = places[:, 2] % 2
    for axis in range(2):
        places[:, axis] = margin + step[axis] * (places[:, axis] + 0.5 * odd)
    places[:, 2] = margin + height * places[:, 2]
    if places[:, 2].max() > box[2] - margin:
        raise SystemExit(f"{count} granules do not fit a box of {box} as a lattice")
    jitter = np.random.default_rng(3).uniform(-0.004, 0.004, places.shape) * radius
    state = np.zeros((count, 11))
    state[:, 0] = np.arange(count)
    state[:, 1:4] = places + jitter
    state[:, 4] = radius
    state[:, 5] = START_SPEED
    return state


def tiled(state, box, radius):
    """Two by two of a bed, two and a half layers high."""
    top = state[:, 3].max() + 1.01 * radius
    lower_half = state[np.argsort(state[:, 3], kind="stable")[: len(state) // 2]]
    parts = []
    for layer, bed in enumerate((state, state, lower_half)):
        for ix in range(2):
            for iy in range(2):
                part = bed.copy()
                part[:, 1:4] += (ix * box[0], iy * box[1], layer * top)
                parts.append(part)
    whole = np.concatenate(parts)
    whole[:, 0] = np.arange(len(whole))
    return whole


def write_csv(name, state):
    file = states / f"{name}.csv"
    np.savetxt(str(file) + ".part", state, fmt=["%d"] + ["%.17g"] * 10, delimiter=",", header=COLUMNS, comments="")
    shutil.move(str(file) + ".part", file)
    return file


def read_csv(name):
    return np.loadtxt(states / f"{name}.csv", delimiter=",", skiprows=1)


def general(name):
    """The same state with one radius larger by 1e-12: the program then runs its kernels for several radii."""
    file = states / f"{name}_general.csv"
    if not file.exists():
        state = read_csv(name)
        state[0, 4] *= 1.0 + 1.0e-12
        write_csv(f"{name}_general", state)
    return file


def data_file(name, types):
    """The state as a data file of LAMMPS (one type of atom) or LIGGGHTS (two: granules and walls)."""
    scene(name)
    _, box, _, shaken, _ = SCENES[name]
    return write_data(name, types, box, shaken)


def write_data(name, types, box, shaken):
    """The same of any state in NAME.csv."""
    file = states / f"{name}.data{types}"
    if file.exists():
        return file
    state = read_csv(name)
    if shaken:
        state[:, 5] -= START_SPEED
    margin = 1.0e-4
    with open(str(file) + ".part", "w", encoding="utf-8") as out:
        out.write(f"{name}\n\n{len(state)} atoms\n{types} atom types\n\n")
        for axis, length in zip("xyz", box):
            out.write(f"{-margin} {length + margin} {axis}lo {axis}hi\n")
        out.write("\nAtoms\n\n")
        out.writelines("%d 1 %.17g %.17g %.17g %.17g %.17g\n" % (k + 1, 2.0 * p[4], DENSITY, p[1], p[2], p[3])
                       for k, p in enumerate(state))
        out.write("\nVelocities\n\n")
        out.writelines("%d %.17g %.17g %.17g %.17g %.17g %.17g\n" % (k + 1, *p[5:11]) for k, p in enumerate(state))
    shutil.move(str(file) + ".part", file)
    return file

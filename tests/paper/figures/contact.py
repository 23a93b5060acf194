"""Figs. 2, 6 and 7: one head-on contact of Table 1's granules, its force, its rebound, and what the step does to it."""

import numpy

from .page import Section
from .settings import PAIRS, STEPS_PER_CONTACT

RADIUS, DENSITY, SPEED, ALPHA = 1.5e-3, 1190.0, 2.5, 0.077  #: Table 1, SI; each granule's speed
MASS = 4.0 / 3.0 * numpy.pi * RADIUS ** 3 * DENSITY
EFFECTIVE = MASS / 2.0
STIFFNESS = 1.0e7 * numpy.sqrt(RADIUS / 3.0e-3)  #: N/m^1.5
CLOSING = 2.0 * SPEED
DURATION = 3.2180 * (EFFECTIVE ** 2 / (STIFFNESS ** 2 * CLOSING)) ** 0.2  #: T_c, undamped, s
RESTITUTION = 0.8974  #: of alpha = 0.077


def alpha_of(restitution):
    return -numpy.sqrt(5.0) * numpy.log(restitution) / numpy.hypot(numpy.log(restitution), numpy.pi)


def pairs(gaps, step, duration, alpha=ALPHA, integrator="leapfrog", output="", reach=0.02):
    """A scene of pairs far from each other, each closing head-on along x over its gap (m)."""
    side = int(numpy.ceil(len(gaps) ** 0.5))
    positions, velocities = [], []
    for k, gap in enumerate(gaps):
        y, z = (k % side + 0.5) * reach, (k // side + 0.5) * reach
        for sign in (-1.0, 1.0):
            positions.append([0.5 * reach + sign * (RADIUS + 0.5 * gap), y, z])
            velocities.append([-sign * SPEED, 0.0, 0.0])
    steps = int(round(duration / step))
    return f"""title = "head-on contacts of Table 1"
gravity = [0.0, 0.0, 0.0]
[enclosure]
shape = "box"
size  = [{reach}, {side * reach}, {side * reach}]
[[granules]]
name    = "acrylic"
radius  = {RADIUS}
density = {DENSITY}
positions  = {[[float(x) for x in p] for p in positions]}
velocities = {velocities}
[contact]
damping  = {'"tsuji"' if alpha else '"none"'}
friction = "none"
[contact.granule]
stiffness        = 1.0e7
reference_radius = 3.0e-3
{f"alpha = {alpha!r}" if alpha else ""}
[time]
duration     = {steps * step!r}
step         = {step!r}
impact_speed = {CLOSING}
integrator   = "{integrator}"
[output]
energy = false
{output}
"""


def every_step(step):
    return f"history_interval = {step!r}\nsnapshot_interval = {step!r}\ncheckpoint_interval = 0.0"


def start(runs, *arguments, **options):
    # The scene says all of its output itself.
    return runs.start(pairs(*arguments, **options), {"output.checkpoint_interval": 0.0,
                                                     "output.history_interval": arguments[1]})


def followed(run):
    """Time from touch (s), overlap (m), approach (m/s) and force (N) of a pair, from its snapshots."""
    time, position, velocity = run.snapshots()
    overlap = 2.0 * RADIUS - (position[:, 1, 0] - position[:, 0, 0])
    approach = velocity[:, 0, 0] - velocity[:, 1, 0]
    force = numpy.zeros_like(time)
    force[1:-1] = -MASS * (velocity[2:, 0, 0] - velocity[:-2, 0, 0]) / (time[2:] - time[:-2])
    touch = numpy.argmax(overlap > 0.0)
    begin = time[touch] - overlap[touch] / approach[touch]
    return time - begin, overlap, approach, force


def fig2(runs):
    step = DURATION / 2000.0
    cases = {"undamped": 0.0, "alpha = 0.077, e = 0.897": ALPHA, "e = 0.5": float(alpha_of(0.5))}
    begun = {name: start(runs, [5.0 * step], step, 1.4 * DURATION, alpha=a, output=every_step(step)) for name, a in cases.items()}
    yield
    section = Section("fig2", "the force of one contact")
    section.text(f"""Two granules of Table 1 (1.5 mm, 1190 kg/m^3, k_n = 7.07e6 N/m^1.5) head-on at {SPEED} m/s each, step T_c/2000. The force is the
        change of momentum, from the velocities of snapshots at every step; lines are Eqs. (2) and (6), k_n d^1.5 + alpha (m k_n)^0.5
        d^0.25 d', at the measured overlap and approach speed. The paper prints a curve.""")
    seen = {name: followed(run.result()) for name, run in begun.items()}
    law = {name: STIFFNESS * numpy.maximum(d, 0.0) ** 1.5 + cases[name] * numpy.sqrt(EFFECTIVE * STIFFNESS) *
           numpy.maximum(d, 0.0) ** 0.25 * v * (d > 0.0) for name, (_, d, v, _) in seen.items()}

    def draw(axes):
        for k, (name, (t, d, _, force)) in enumerate(seen.items()):
            inside = d > -1.0e-6
            axes[0].plot(1e6 * t[inside][::40], force[inside][::40], f"C{k}o", markersize=2.5)
            axes[0].plot(1e6 * t[inside][::10], law[name][inside][::10], f"C{k}-", linewidth=0.8, label=name)
            axes[1].plot(1e6 * d[inside][::40], force[inside][::40], f"C{k}o", markersize=2.5)
            axes[1].plot(1e6 * d[inside][::10], law[name][inside][::10], f"C{k}-", linewidth=0.8)
        axes[0].set_xlabel("time from touch, us")
        axes[1].set_xlabel("overlap, um")
        for axis in axes:
            axis.set_ylabel("force, N")
        axes[0].legend(loc="upper right")
        axes[0].set_xlim(-2, 62)

    section.picture(draw, columns=2, size=(8.0, 3.4))
    deepest = (5.0 * EFFECTIVE * CLOSING ** 2 / (4.0 * STIFFNESS)) ** 0.4
    rows, worst = [], 0.0
    for name, (t, d, v, force) in seen.items():
        # Where it begins the law is steeper than differences follow.
        error = numpy.abs(force - law[name])[d > 1.0e-6].max() / force.max()
        worst = max(worst, error)
        rows.append([name, f"{force.max():.2f}", f"{min(force.min(), 0.0):.2f}", f"{1e6 * d.max():.2f}", f"{-v[-1] / CLOSING:.4f}", f"{error:.1e}"])
    section.table(["contact", "greatest force, N", "greatest pull, N", "deepest overlap, um", "restitution", "off Eqs. (2), (6) beyond 1 um, of the greatest"],
                  rows)
    section.text(f"""Closed form, undamped: deepest {1e6 * deepest:.2f} um, greatest force {STIFFNESS * deepest ** 1.5:.2f} N. At the end of a damped
        contact the force pulls, as the paper's law has it (`tension = true`).""")
    section.bound("deepest overlap, undamped, um", 1e6 * seen["undamped"][1].max(), 1e6 * deepest, 1.0e-3)
    section.bound("restitution of alpha = 0.077", -seen["alpha = 0.077, e = 0.897"][2][-1] / CLOSING, RESTITUTION, 1.0e-3)
    section.check("force against the law", worst < 5e-3, f"{worst:.1e}", "below 5e-3 of the greatest")
    section.verdict = f"a curve only; the force is Eqs. (2) and (6) to {worst:.0e} of its greatest"
    yield section


def fig6(runs):
    steps = {"T_c/8": DURATION / 8.0, "5e-7 s, as the paper": 5.0e-7, "T_c/5000": DURATION / 5000.0}
    gaps = {name: 1.0e-9 if name == "T_c/5000" else 0.5 * CLOSING * step for name, step in steps.items()}
    begun = {}
    for name, step in steps.items():
        fine = name == "T_c/5000"
        begun[name] = start(runs, [gaps[name]], step, 1.5 * DURATION,
                            output=f"snapshot_interval = {(40 if fine else 1) * step!r}")
    yield
    section = Section("fig6", "rebound of a head-on pair")
    section.text(f"""Table 1's granules at {SPEED} m/s each, alpha = {ALPHA}. The duration is the number of steps in contact times the step.""")
    rows, drawn, measured = [], {}, {}
    for name, run in begun.items():
        done = run.result()
        contacts, = done.history("contacts")
        _, velocity = done.end()
        measured[name] = (abs(velocity[0, 0]), contacts[:-1].sum() * steps[name])
        time, _, v = done.snapshots()
        drawn[name] = (time - gaps[name] / CLOSING, v)
        rows.append([name, f"{measured[name][0]:.4f}", f"{measured[name][1]:.3e}"])
    section.table(["step", "rebound, m/s", "duration, s"], [*rows, ["independent, converged", "2.2435", "4.008e-05"],
                                                            ["paper", "2.244", "4.05e-05"]])
    section.text("""The paper's duration is read off at steps of 5e-7 s, and lies within one of them of the converged one.""")

    def draw(axes):
        for k, (name, (t, v)) in enumerate(drawn.items()):
            style = "-" if name == "T_c/5000" else "o"
            for granule in (0, 1):
                axes.plot(1e6 * t, v[:, granule, 0], style, color=f"C{k}", markersize=5 if k == 0 else 2.5, linewidth=0.8,
                          label=name if granule == 0 else None, zorder=3 - k)
        axes.axhline(2.244, color="r", linestyle="--", linewidth=0.7, label="rebound, paper")
        axes.axhline(-2.244, color="r", linestyle="--", linewidth=0.7)
        axes.set_xlim(-3, 55)
        axes.set_xlabel("time from touch, us")
        axes.set_ylabel("velocity, m/s")
        axes.legend(loc="center right")

    section.picture(draw, size=(5.6, 3.4))
    section.bound("rebound, converged, m/s", measured["T_c/5000"][0], 2.2435, 1.0e-3)
    section.bound("duration, converged, s", measured["T_c/5000"][1], 4.008e-5, 1.0e-3)
    section.bound("rebound at 5e-7 s against the paper, m/s", measured["5e-7 s, as the paper"][0], 2.244, 1.0e-3)
    section.verdict = f"reproduced: {measured['T_c/5000'][0]:.4f} m/s (paper 2.244), {measured['T_c/5000'][1]:.3e} s (independent 4.008e-05)"
    yield section


def fig7(runs):
    phases = (numpy.arange(PAIRS) + 0.5) / PAIRS
    begun = {}
    for integrator in ("leapfrog", "verlet"):
        for k in STEPS_PER_CONTACT:
            step = DURATION / k
            begun[integrator, k] = start(runs, CLOSING * step * (1.0 + phases), step, 1.8 * DURATION + 2.0 * step, integrator=integrator)
    yield
    section = Section("fig7", "restitution at different time steps")
    section.text(f"""The contact of Fig. 6 at T_c/k. What a step gives depends on where in it the contact begins: {PAIRS} pairs in one run, each at
        another phase, and of their restitutions the mean, least and greatest. alpha = {ALPHA} is e = {RESTITUTION}.""")
    e = {}
    for key, run in begun.items():
        _, velocity = run.result().end()
        e[key] = (velocity[1::2, 0] - velocity[0::2, 0]) / CLOSING
    independent = {("leapfrog", 4): 0.900, ("leapfrog", 8): 0.8976, ("leapfrog", 16): 0.8973, ("verlet", 4): 0.873,
                   ("verlet", 8): 0.890, ("verlet", 16): 0.8955}
    section.table(["k", "leapfrog, mean (least, greatest)", "independent", "velocity Verlet, mean (least, greatest)", "independent"],
                  [[k, *(cell for i in ("leapfrog", "verlet") for cell in (
                      f"{e[i, k].mean():.4f} ({e[i, k].min():.4f}, {e[i, k].max():.4f})", independent.get((i, k), "-")))]
                   for k in STEPS_PER_CONTACT])

    def draw(axes):
        for c, (integrator, shift) in enumerate((("leapfrog", 0.97), ("verlet", 1.03))):
            x = numpy.array(STEPS_PER_CONTACT) * shift
            mean = numpy.array([e[integrator, k].mean() for k in STEPS_PER_CONTACT])
            low = numpy.array([e[integrator, k].min() for k in STEPS_PER_CONTACT])
            high = numpy.array([e[integrator, k].max() for k in STEPS_PER_CONTACT])
            axes.errorbar(x, mean, [mean - low, high - mean], fmt="o-", color=f"C{c}", markersize=4, capsize=3,
                          label=f"{'velocity Verlet' if c else 'leapfrog'}: mean, least and greatest phase")
            known = [k for k in STEPS_PER_CONTACT if (integrator, k) in independent]
            axes.plot(numpy.array(known) * shift, [independent[integrator, k] for k in known], "g^", markersize=5,
                      label="independent, mean" if c else None, zorder=3)
        axes.axhline(RESTITUTION, color="k", linewidth=0.7, linestyle="--", label="exact")
        axes.set_xscale("log", base=2)
        axes.set_xticks(STEPS_PER_CONTACT, [f"T_c/{k}" for k in STEPS_PER_CONTACT])
        axes.set_xlabel("time step")
        axes.set_ylabel("restitution")
        axes.legend()

    section.picture(draw, size=(6.0, 3.4))
    for (integrator, k), value in independent.items():
        section.bound(f"{'velocity Verlet' if integrator == 'verlet' else integrator}, T_c/{k}", e[integrator, k].mean(), value, {4: 1.5e-3, 8: 1.0e-3, 16: 5.0e-4}[k], relative=False)
    section.verdict = f"""the independent program's means at every step; at T_c/8 leapfrog has {e['leapfrog', 8].mean():.4f} (exact {RESTITUTION}),
        velocity Verlet {e['verlet', 8].mean():.4f}"""
    yield section

"""What each effect costs: one bed, effects switched on one after the other."""

import re
import shutil

from . import sizes, states
from .common import Report, build, in_turn, instruction_sets, number, overrides, perf, quick, repeats, run, spread, step_timer
from .common import median

OFF = {"gravity": "[0, 0, 0]", "contact.friction": "none"}
LADDER = [  # what is added, the overrides that it changes, and those that it takes back
    ("frictionless, one radius, no gravity, no structure", {}, ()),
    ("gravity", {}, ("gravity",)),
    ("structure, driven", {"structure.mass": 1.0, "structure.stiffness": 4.0e4, "structure.damping": 0.0,
                           "structure.direction": "[1, 0, 0]", "excitation.kind": "harmonic",
                           "excitation.frequency": 15.9, "excitation.static_deflection": 1.0e-4}, ()),
    ("friction, no rotation", {"contact.rotation": "false"}, ("contact.friction",)),
    ("rotation", {}, ("contact.rotation",)),
    ("several radii", {"granules.0.file": "effects_radii.csv"}, ()),
    ("several materials", {"granules.1.young": 3.5244001e8}, ()),
    ("ledger", {"output.energy": "true"}, ()),
    ("audit, every 100 steps", {"verlet.audit": 100}, ()),
]
#: Instead of what the bed with several radii has; springs remember their contacts and cost memory besides.
VARIANTS = [
    ("Coulomb friction, double", {}),
    ("mixed precision", {"time.precision": "mixed"}),
    ("tangential springs", {"contact.friction": "spring"}),
    ("contacts that only push", {"contact.tension": "false"}),
    ("velocity Verlet", {"time.integrator": "verlet"}),
]
#: Of the contacts between granules and with the walls of S3, whose stiffness is given.
SPRINGS = {"time.step": 3.0e-6, "contact.friction": "spring", "contact.granule.tangential_stiffness": 8.0e6,
           "contact.wall.tangential_stiffness": 1.0e7}
SPRING_MEMORY = {True: 10000, False: 100000}
PHASES = {"pairs": ("pair_kernel", "PairLoop"), "walls": ("wall_kernel", "WallLoop"),
          "motion": ("motion_kernel", "MotionLoop"), "audit": ("Audit", "_Rb_tree"),
          "list": ("candidate_kernel", "split_kernel", "VerletList", "CellGrid", "Granules", "list_walls", "classed",
                   "distance_inside")}


def stages():
    settings = dict(OFF)
    for name, added, taken_back in LADDER:
        settings = {key: value for key, value in settings.items() if key not in taken_back} | added
        yield name, dict(settings)


def scene(bed_name):
    states.scene(bed_name)
    bed = states.read_csv(bed_name)
    bed[:, 5] -= states.START_SPEED if states.SCENES[bed_name][3] else 0.0  # the box stands still at first
    for name, part in (("even", bed[::2]), ("odd", bed[1::2]), ("radii", bed[::2].copy())):
        if name == "radii":
            part[0, 4] *= 1.0 + 1.0e-12
        part[:, 0] = range(len(part))
        states.write_csv(f"effects_{name}", part)
    target = states.states / "effects.toml"
    shutil.copyfile(perf / "scenes" / "effects.toml", target)
    return target


def counted(file, settings, steps):
    """Instructions executed by function in the timed steps, on the AVX2 kernels: {mangled name: number}."""
    out = states.states / "callgrind.out"
    run(["valgrind", "--tool=callgrind", "--collect-atstart=no", "--demangle=no", f"--callgrind-out-file={out}",
         build / "perf" / "step_timer", file, *overrides(settings), "--isa", "avx2", "--warm", 10, "--steps", steps])
    names, counts, current, skip = {}, {}, None, False
    for line in out.read_text(encoding="utf-8").splitlines():
        if line.startswith(("fn=", "cfn=")):
            kind, _, rest = line.partition("=")
            key, _, name = rest.partition(" ")
            if name:
                names[key] = name
            if kind == "fn":
                current = names[key]
        elif line.startswith("calls="):
            skip = True  # the next line is what the called function costs
        elif line and (line[0].isdigit() or line[0] in "+-*") and current is not None:
            parts = line.split()
            if not skip and len(parts) > 1:
                counts[current] = counts.get(current, 0) + int(parts[1])
            skip = False
    return counts


def by_phase(counts):
    phases = dict.fromkeys([*PHASES, "other"], 0)
    for name, count in counts.items():
        phases[next((p for p, parts in PHASES.items() if any(part in name for part in parts)), "other")] += count
    return phases


def kernel_content(counts):
    """The pair kernel that ran, and how many square roots, divisions and instructions stand in its code."""
    symbols = sorted((name for name in counts if "pair_kernel" in name or "PairLoop" in name), key=counts.get)
    code = ""
    for symbol in symbols:
        if "deepest" in symbol:  # called where a contact could be the deepest so far, and no part of its work
            continue
        symbol = symbol.split("'")[0]
        code += run(["objdump", "-d", "--no-show-raw-insn", f"--disassemble={symbol}", build / "perf" / "step_timer"])
    instructions = re.findall(r"^ +[0-9a-f]+:\t(\S+)", code, re.M)
    return {"symbol": run(["c++filt", symbols[-1]]).strip() if symbols else "-",
            "roots": sum(i.startswith(("vsqrtpd", "vsqrtps")) for i in instructions),
            "divisions": sum(i.startswith(("vdivpd", "vdivps")) for i in instructions),
            # The second halves of the rows of motion and force, spin and turn: nothing else but the stack is 32 bytes in.
            "spins": len(re.findall(r"\tv\S+ .*[ ,]0x20\(%r(?!sp)\w+(?:,%r\w+,2)?\)", code)), "instructions": len(instructions)}


def effects_of(symbol):
    """Damping, friction, variety and observation of the kernel, out of its demangled name."""
    numbers = dict(re.findall(r"\(grandamp::kernels::(Damping|Friction|Variety|Observation|Precision)\)(\d)", symbol))
    if "ContactEffects" not in symbol:
        return symbol
    source = (perf.parent / "kernels" / "effects.hpp").read_text(encoding="utf-8")
    words = {}
    for kind in ("Damping", "Friction", "Variety", "Observation", "Precision"):
        body = re.sub(r"//.*", "", re.search(rf"enum class {kind} {{(.*?)}}", source, re.S)[1])
        words[kind] = [word.strip() for word in body.split(",") if word.strip()]
    # A name leaves out zeros at its end.
    return ", ".join(f"{kind.lower()} {word[int(numbers.get(kind, 0))].replace('_', ' ')}" for kind, word in words.items())


def measure(file, counted_steps, steps, windows):
    """Rows of the ladder, what stands in the pair kernels, and the share of the frictionless time per contact."""
    ladder = list(stages())
    taken = in_turn({name: lambda s=s: step_timer(file, s, steps=steps, warm=20, windows=windows) for name, s in ladder})
    rows, code, per_contact, previous = [], [], [], None
    for name, settings in ladder:
        of = taken[name][-1]
        granules = of["granules"]
        times = [median(t["processor_ns_per_step"]) / granules for t in taken[name]]
        per_contact.append(median(times) / of["contacts_per_granule"])
        row = [f"+ {name}" if rows else name, number(median(times)), f"{spread(times):.0f}", number(per_contact[-1]),
               number(of["contacts_per_granule"])]
        if counted_steps:
            counts = counted(file, settings, counted_steps)
            phases = {phase: count / counted_steps / granules for phase, count in by_phase(counts).items()}
            total = sum(phases.values())
            row += [number(total), f"{total - previous:+.1f}" if rows else "", *(f"{phases[p]:.1f}" for p in phases)]
            previous = total
            content = kernel_content(counts)
            code.append([row[0], effects_of(content["symbol"]), content["roots"], content["divisions"],
                         content["spins"], content["instructions"]])
        rows.append(row)
    return rows, code, per_contact[0] / per_contact[5]


def main():
    steps, counted_steps, windows = (100, 10, 2) if quick else (400, 200, 15)
    if "avx2" not in instruction_sets():
        counted_steps = 0
    report = Report("effects", "What each effect costs", f"""One bed; each line adds one effect to those above it. Time: processor time per granule-step, ns, the median of
{windows} windows of {steps} steps from the same start, and of {repeats} runs in turn. *per contact*: the whole step's time over the
granules' and walls' contacts. Instructions: executed per granule-step in {counted_steps} steps, counted by callgrind on the AVX2
kernels, by phase. Without friction there is nothing that turns a granule, so rotation is absent with it.""")
    head = ["effects", "ns", "half range, %", "ns per contact", "contacts per granule"]
    if counted_steps:
        head += ["instructions", "more", *PHASES, "other"]
    for bed, title in (("S1_rest", "At rest: the contact law rules"), ("S1", "Shaken: the bed of S1, thrown up")):
        rows, code, share = measure(scene(bed), counted_steps, steps, windows)
        report.table(head, rows, title)
        report.text(f"Frictionless, one radius, no gravity against the full scene with several radii, whole steps per contact: "
                    f"{100.0 * share:.0f} %. (Of the kernels alone, where at most 60 % is wanted: `perf/run.sh kernels`.)")
    rows, more = variants(scene("S1_rest"), counted_steps, steps, windows)
    head = ["instead", "ns", "half range, %", "of double", "contacts per granule", "candidates per granule",
            "bytes per granule"]
    if counted_steps:
        head += ["instructions", *PHASES, "other"]
    report.table(head, rows, "At rest, several radii: one effect exchanged for another")
    report.text("Bytes: what the process holds more after the steps than before the granules were placed; of so few "
                "granules a good part is scratch of fixed size, and the table below tells more.")
    code += more
    bytes_of = {name: step_timer(sizes.memory_scene(SPRING_MEMORY[quick]), settings, steps=3, warm=20)
                for name, settings in (("Coulomb friction", {}), ("tangential springs", SPRINGS))}
    report.table(["friction", "granules", "bytes per granule", "candidates per granule", "contacts per granule"],
                 [[name, f"{of['granules']:,}", number(of["bytes_per_granule"]), number(of["candidates_per_granule"]),
                   number(of["contacts_per_granule"])] for name, of in bytes_of.items()],
                 "Memory of the contacts' springs, a large bed (granules by count)")
    if code:
        report.table(["effects", "the pair kernel that ran (from callgrind)", "square roots", "divisions", "spin and turn", "instructions"],
                     code, "What stands in the pair kernel's code")
        check(code, report)
    report.write()


def variants(file, counted_steps, steps, windows):
    """The bed with several radii and one of its effects exchanged, in turn; their time, instructions and memory."""
    base = list(stages())[5][1] | {"time.step": 4.0e-6}  # springs are not stable at the ladder's
    taken = in_turn({name: lambda s=base | change: step_timer(file, s, steps=steps, warm=20, windows=windows)
                     for name, change in VARIANTS})
    rows, code, first = [], [], None
    for name, change in VARIANTS:
        of = taken[name][-1]
        granules = of["granules"]
        times = [median(t["processor_ns_per_step"]) / granules for t in taken[name]]
        first = first or median(times)
        row = [name, number(median(times)), f"{spread(times):.0f}", f"{100.0 * median(times) / first:.0f} %",
               number(of["contacts_per_granule"]), number(of["candidates_per_granule"]),
               number(median([t["bytes_per_granule"] for t in taken[name]]))]
        if counted_steps:
            counts = counted(file, base | change, counted_steps)
            phases = {phase: count / counted_steps / granules for phase, count in by_phase(counts).items()}
            content = kernel_content(counts)
            row += [number(sum(phases.values())), *(f"{phases[p]:.1f}" for p in phases)]
            code.append([name, effects_of(content["symbol"]), content["roots"], content["divisions"], content["spins"],
                         content["instructions"]])
        rows.append(row)
    return rows, code


def check(code, report):
    """The frictionless kernel must be without friction, by its name and by what it computes."""
    bare, full = code[0], code[4]
    if "friction none" not in bare[1] or bare[2] >= full[2] or bare[4] != 0 or full[4] == 0:
        raise SystemExit(f"the frictionless kernel holds friction: {bare}, {full}")
    report.text(f"Checked: the kernel of the frictionless bed has {bare[2]} vector square roots in its code where friction's "
                f"has {full[2]} (the slip's length is the one more), {bare[5]} instructions where that has {full[5]}, and none of them touches a row of spin or turn "
                f"(friction's: {full[4]}).")

"""Each kernel by itself (Google Benchmark), for each instruction set of the machine."""

import json
import tempfile

from .common import Report, build, median, number, quick, repeats, run

#: Wanted at most, ns, of the best instruction set; set for AVX-512.
TARGETS = {"pair_contact/full_several_radii": 5.0, "pair_candidate/full_several_radii": 0.8,
           "build/2k_several_radii": 30.0, "build/100k_several_radii": 36.0, "build/1M_several_radii": 45.0}

ORDER = ("pair_candidate", "pair_contact", "wall_candidate", "wall_contact", "motion", "build", "limit")


def measured():
    """{(set, what): list of ns per item}. The repeats are interleaved at random, so that all see the same machine."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        run([build / "perf" / "kernel_bench", f"--benchmark_out={out.name}", "--benchmark_out_format=json",
             f"--benchmark_repetitions={repeats}", "--benchmark_enable_random_interleaving=true",
             f"--benchmark_min_time={0.02 if quick else 0.1}"])
        data = json.load(open(out.name, encoding="utf-8"))
    values = {}
    for entry in data["benchmarks"]:
        if entry.get("run_type") == "iteration":
            name = entry["run_name"].split("/repeats")[0]
            instruction_set, what = name.split("/", 1)
            values.setdefault((instruction_set, what), []).append(entry["ns_per_item"])
    return values


def main():
    values = measured()
    sets = [s for s in ("generic", "avx2", "avx512") if any(s == of for of, _ in values)]
    kinds = sorted({w for _, w in values}, key=lambda w: (ORDER.index(w.split("/")[0]), w))
    report = Report("kernels", "Each kernel by itself", f"""Processor time, ns per item, medians of {repeats} repetitions in random order. Items: candidates tested (none
touches), contacts (all candidates touch; test included), wall candidates and contacts, granules moved, granules sorted and
listed (2k, 100k, 1M of them, moved by up to 0.1 r since the last list). Beds of 2,197 granules (352 KB of rows) unless
said. Targets were set for AVX-512.""")
    rows = []
    for what in kinds:
        row = [what.replace("_", " ")]
        for instruction_set in sets:
            of = values.get((instruction_set, what))
            row.append(number(median(of)) if of else "-")
        row.append(number(TARGETS[what]) if what in TARGETS else "")
        rows.append(row)
    report.table(["kernel", *sets, "target (AVX-512), at most"], rows)
    ratios = []
    for instruction_set in sets:
        bare = median(values[(instruction_set, "pair_contact/frictionless")])
        for full in ("full_one_radius", "full_several_radii"):
            ratios.append([instruction_set, full.replace("_", " "),
                           f"{100.0 * bare / median(values[(instruction_set, f'pair_contact/{full}')]):.0f} %"])
    report.table(["instruction set", "full scene", "frictionless, one radius: time per contact over the full scene's"],
                 ratios, "Paying only for what is there (target: at most 60 %)")
    report.write()

"""What accuracy costs in time: `grandamp study accuracy` of Table 5 and of a bed of 20,000 granules."""

import json
import shutil

from .common import Report, build, overrides, perf, quick, results, run

#: Scene, overrides, seeds, what is varied. Durations are short: the seeds' scatter, which falls with the root of all
#: that is simulated, is told beside every difference.
STUDIES = {
    "table5": (perf.parent / "io" / "scenes" / "table5.toml",
               {"time.duration": 2.5, "output.window": "[1.0, 2.5]"}, 3, None),
    "bed": (perf / "scenes" / "accuracy_bed.toml", {}, 2, "steps,precision,policy"),
}
QUICK = {"table5": {"time.duration": 0.2, "output.window": "[0.05, 0.2]"},
         "bed": {"granules.0.count": 500, "time.duration": 0.02, "output.window": "[0.0, 0.02]"}}
PICTURES = ("error_time", "response_time", "rate_step", "missed_policy")


def accuracy():
    report = Report("accuracy", "What accuracy costs in time", """`grandamp study accuracy` of two scenes. Each study is kept in the build folder: begun again, it goes on where it
was; remove it for new timings. What lowers the error of a contact at the same step, tried apart from the solver, is in
perf/ACCURACY.md.""")
    for name, (scene, settings, seeds, vary) in STUDIES.items():
        folder = build / ("studies-quick" if quick else "studies") / name
        folder.parent.mkdir(parents=True, exist_ok=True)
        settings = {**settings, **(QUICK[name] if quick else {})}
        command = [build / "grandamp", "study", "accuracy", scene, "-o", folder, "--seeds", 2 if quick else seeds,
                   "--error", "1%", "--quiet", *overrides(settings)]
        if vary:
            command += ["--vary", vary, "--threads", 1]
        run(command)
        study = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        text = (folder / "study.md").read_text(encoding="utf-8").replace("# What accuracy costs in time", "## ", 1)
        text = text.replace("## : ", "## ", 1)
        for picture in PICTURES:
            file = f"accuracy_{name}_{picture}.svg"
            shutil.copyfile(folder / f"{picture}.svg", results / file)
            text = text.replace(f"]({picture}.svg)", f"]({file})")
        shutil.copyfile(folder / "study.csv", results / f"accuracy_{name}.csv")
        report.text(text.rstrip())
        report.text("Command: `grandamp " + " ".join(str(part) for part in command[1:4]).replace(str(perf.parent) + "/", "") +
                    " " + " ".join(str(part) for part in overrides(settings)) + f" --seeds {seeds}`")
        print(f"{name}: {study['recommended']['text']}")
    report.write()

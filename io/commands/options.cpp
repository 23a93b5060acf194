#include "io/commands/options.hpp"

#include "io/study.hpp"

#include <CLI/CLI.hpp>

namespace grandamp {

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "Override a scene key, dotted; list items by index: granules.0.count=100")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Threads; default: chosen by the number of granules")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
}

void add_isa(CLI::App& command, std::string& isa) {
  command.add_option("--isa", isa, "Instruction set of the kernels; default: the best of this machine")
      ->check(CLI::IsMember({"generic", "avx2", "avx512"}));
}

void add_quiet(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet", quiet, "Only warnings and errors");
}

namespace {

void add_keep(CLI::App& command, std::string& keep) {
  command.add_option("--keep", keep, "What stays: total_mass of the granules, whose count (or radius) then follows")
      ->check(CLI::IsMember({"total_mass"}));
}

/// What sweeps, searches and studies have alike. `what` they are, and `table` is the file that --json prints.
void add_case_options(CLI::App& command, CaseArguments& arguments, const std::string& what, const std::string& table,
                      const std::string& runs) {
  command.add_option("SCENE", arguments.scene, "Scene file, TOML")->required();
  command.add_option("-o", arguments.folder, "Folder of the " + what + "; default: the scene's stem")->type_name("DIR");
  command.add_option("--seeds", arguments.seeds, runs + "; default " + std::to_string(arguments.seeds))
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  add_overrides(command, arguments.overrides);
  command.add_option("--threads", arguments.threads, "Runs at a time; default: what the process may use")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  add_isa(command, arguments.isa);
  command.add_flag("--force", arguments.force, "Replace the " + what + " that the folder holds");
  add_quiet(command, arguments.quiet);
  command.add_flag("--json", arguments.json, "Print " + table + " on standard output");
  command
      .add_option("--max-wall", arguments.max_wall,
                  "After so much wall time let all runs stop; status 130; given again, "
                  "the command goes on")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber);
}

} // namespace

void add_study(CLI::App& command, StudyArguments& study) {
  add_case_options(command, study, "study", "study.json", "Runs of each setting; their scatter tells what is chance");
  command.add_option("--error", study.error, "Recommend settings for this error, 0.01 or 1%")->type_name("E");
  command.add_option("--vary", study.vary, "What to vary; default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(std::begin(study_groups), std::end(study_groups))));
}

void add_sweep(CLI::App& command, SweepArguments& sweep) {
  add_case_options(command, sweep, "sweep", "sweep.json", "Runs of each point, from seeds that follow the scene's");
  command
      .add_option("--vary", sweep.vary,
                  "A scene key and its values, both ends included: KEY=START:STOP:COUNT, by equal factors with :log at "
                  "the end, or KEY=a,b,c; several: their grid")
      ->type_name("KEY=VALUES")
      ->required()
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_keep(command, sweep.keep);
  command.add_option("--index", sweep.index, "With --of: run this part only, from 0")->type_name("I");
  command.add_option("--of", sweep.of, "Parts that the runs are dealt out to, as for job arrays")->type_name("N");
  command.footer("Given again, the command runs only what is missing. Examples:\n"
                 "  grandamp sweep damper.toml --vary excitation.frequency=15.5:16.5:11 --seeds 3\n"
                 "      the response, with error bars, beside the bare structure and the granules as added mass\n"
                 "  grandamp sweep damper.toml --vary excitation.static_deflection=1e-5:1e-3:9:log\n"
                 "      damping against dimensionless acceleration\n"
                 "  grandamp sweep damper.toml --vary granules.0.radius=1.4e-3:2.5e-3:6 --keep total_mass\n"
                 "      granules' size at one total mass\n"
                 "  grandamp sweep damper.toml --vary contact.friction=coulomb,none --vary structure.damping=0.1,0.2\n"
                 "      every friction law with every damping");
}

void add_optimise(CLI::App& command, OptimiseArguments& optimise) {
  add_case_options(command, optimise, "search", "optimise.json", "Runs of each design, the same seeds for all");
  CLI::Option* const least = command.add_option("--minimise", optimise.minimise,
                                                "A number of summary.json, dotted: structure.rms_displacement");
  least->type_name("KEY");
  command.add_option("--maximise", optimise.maximise, "The same, to be as great as can be")
      ->type_name("KEY")
      ->excludes(least);
  command
      .add_option("--over", optimise.over, "A scene key and its bounds: KEY=A:B, by equal factors with :log; several")
      ->type_name("KEY=A:B")
      ->required()
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--evaluations", optimise.evaluations, "Designs at most; default 20")
      ->type_name("N")
      ->check(CLI::Range(2, 10000));
  add_keep(command, optimise.keep);
  command.footer("Given again, the command goes on where it was. Examples:\n"
                 "  grandamp optimise damper.toml --minimise structure.rms_displacement \\\n"
                 "      --over granules.0.radius=1.2e-3:2.6e-3 --keep total_mass\n"
                 "      the granules' size at one total mass; best.toml is the scene to go on with\n"
                 "  grandamp optimise damper.toml --minimise structure.amplitude \\\n"
                 "      --over granules.0.count=50:500 --over contact.wall.friction=0.1:0.8 --evaluations 40");
}

} // namespace grandamp

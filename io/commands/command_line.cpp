#include "io/commands/commands.hpp"
#include "io/commands/options.hpp"
#include "io/run.hpp"
#include "io/version.hpp"
#include "kernels/dispatch.hpp"

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <functional>
#include <new>

namespace grandamp {
namespace {

void log_to_standard_error() {
  auto logger = std::make_shared<spdlog::logger>("grandamp", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  logger->set_pattern("%^%l%$: %v");
  spdlog::set_default_logger(std::move(logger));
}

void add_profile(CLI::App& command, bool& profile) {
  command.add_flag("--profile", profile, "Time by phase in the summary; trace.json for Perfetto or chrome://tracing");
}

void add_max_wall(CLI::App& command, double& seconds) {
  command.add_option("--max-wall", seconds, "Write a checkpoint after so much wall time and stop with status 130")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber);
}

void log_each(spdlog::level::level_enum level, const std::filesystem::path& scene,
              const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) {
    std::string line = format_problems(scene.string(), {problem});
    while (!line.empty() && line.back() == '\n') line.pop_back();
    spdlog::log(level, "{}", line);
  }
}

/// Runs the command that was typed and turns what it throws into messages and exit statuses.
int guarded(const std::filesystem::path& scene, const std::function<int()>& command) {
  try {
    return command();
  } catch (const SceneError& error) {
    tell_faults(scene, error.problems());
    return exit_usage;
  } catch (const UsageError& error) {
    spdlog::error("{}", error.what());
    return exit_usage;
  } catch (const GuardError& error) {
    spdlog::error("{}", error.what());
    return exit_guard;
  } catch (const FileError& error) {
    spdlog::error("{}", error.what());
    return exit_file;
  } catch (const std::filesystem::filesystem_error& error) {
    spdlog::error("{}", error.what());
    return exit_file;
  } catch (const std::bad_alloc&) {
    spdlog::error("out of memory; `grandamp check` tells how much the scene needs");
    return exit_guard;
  }
}

} // namespace

void require_isa(const std::string& isa) {
  using kernels::InstructionSet;
  for (const InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512}) {
    if (isa == kernels::name(set) && !kernels::available(set)) {
      throw UsageError("--isa " + isa + ": not to be had here; the best is " +
                       kernels::name(kernels::best_available()) + " (see --version)");
    }
  }
}

void tell(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw FileError(std::string("standard output: cannot write: ") + std::strerror(errno));
}

void tell_faults(const std::filesystem::path& scene, const std::vector<Problem>& faults) {
  log_each(spdlog::level::err, scene, faults);
}

void tell_notes(const std::filesystem::path& scene, const std::vector<Problem>& notes) {
  log_each(spdlog::level::info, scene, notes);
}

int command_line(int argc, char** argv) {
  log_to_standard_error();
  std::signal(SIGXFSZ, SIG_IGN); // a file that grows beyond a limit is then an error with a reason, not a death

  CLI::App app("Discrete-element simulation of granular dampers", "grandamp");
  app.require_subcommand(1);
  app.set_version_flag(
      "--version", [] { return version_report(); }, "Version, compiler, instruction sets, libraries");

  RunArguments run;
  CLI::App* const run_app = app.add_subcommand("run", "Run a scene");
  run_app->add_option("SCENE", run.scene, "Scene file, TOML")->required();
  run_app->add_option("-o", run.folder, "Folder of the results; default: the scene's stem")->type_name("DIR");
  add_overrides(*run_app, run.overrides);
  add_threads(*run_app, run.threads);
  add_isa(*run_app, run.isa);
  run_app->add_flag("--force", run.force, "Replace the run that the folder holds");
  add_quiet(*run_app, run.quiet);
  run_app->add_flag("--json", run.json, "Print the summary on standard output");
  add_profile(*run_app, run.profile);
  add_max_wall(*run_app, run.max_wall);

  ResumeArguments resumed;
  CLI::App* const resume_app = app.add_subcommand("resume", "Go on with a run from its newest checkpoint");
  resume_app->add_option("DIR", resumed.folder, "Folder of a run")->required();
  add_overrides(*resume_app, resumed.overrides);
  add_threads(*resume_app, resumed.threads);
  add_isa(*resume_app, resumed.isa);
  add_quiet(*resume_app, resumed.quiet);
  resume_app->add_flag("--json", resumed.json, "Print the summary on standard output");
  add_profile(*resume_app, resumed.profile);
  add_max_wall(*resume_app, resumed.max_wall);

  CheckArguments check;
  CLI::App* const check_app = app.add_subcommand("check", "Validate a scene and tell what would run; runs nothing");
  check_app->add_option("SCENE", check.scene, "Scene file, TOML")->required();
  add_overrides(*check_app, check.overrides);
  add_threads(*check_app, check.threads);
  add_isa(*check_app, check.isa);
  add_quiet(*check_app, check.quiet);
  check_app->add_flag("--json", check.json, "Print the plan as JSON on standard output");

  ExportArguments exported;
  bool export_quiet = false;
  CLI::App* const export_app =
      app.add_subcommand("export", "Histories, granules, frequency response or decay of a run");
  export_app->add_option("DIR", exported.folder, "Folder of a run")->required();
  export_app->add_option("WHAT", exported.what, "history, granules, response or decay")
      ->required()
      ->check(CLI::IsMember({"history", "granules", "response", "decay"}));
  export_app->add_option("--time", exported.time, "Of granules, s; default: the end")->type_name("T");
  export_app->add_option("--settling", exported.settling, "Of a response: what is left out at the start, s")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  export_app
      ->add_option("--segment", exported.segment, "Of a response to a force without a period: Welch's segments, s")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  export_app
      ->add_option("-o", exported.file, "FILE.csv; a response also .unv (universal file 58) or .svg, a decay .svg")
      ->type_name("FILE")
      ->required();
  add_quiet(*export_app, export_quiet);

  ReportArguments reported;
  bool report_quiet = false;
  CLI::App* const report_app =
      app.add_subcommand("report", "A page, report.html, with pictures of a run, a sweep or a study");
  report_app->add_option("DIR", reported.folder, "Folder of a run, a sweep or a study")->required();
  add_quiet(*report_app, report_quiet);

  InspectArguments inspected;
  CLI::App* const inspect_app = app.add_subcommand("inspect", "What a results or checkpoint file holds; is it whole?");
  inspect_app->add_option("FILE", inspected.file, "results.h5 or checkpoint.h5")->required();

  StudyArguments study;
  CLI::App* const study_app = app.add_subcommand("study", "What accuracy costs in time");
  study_app->require_subcommand(1);
  CLI::App* const accuracy_app = study_app->add_subcommand(
      "accuracy", "Error against time over step, integrator, precision, list, friction, stiffness");
  add_study(*accuracy_app, study);

  SweepArguments sweep;
  CLI::App* const sweep_app = app.add_subcommand("sweep", "A run per point of a grid of scene keys, several at a time");
  add_sweep(*sweep_app, sweep);

  OptimiseArguments optimise;
  CLI::App* const optimise_app = app.add_subcommand("optimise", "The design for which a number of the summary is best");
  add_optimise(*optimise_app, optimise);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) { // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    spdlog::error("{} (see grandamp --help)", error.what());
    return exit_usage;
  } catch (const UsageError& error) {
    spdlog::error("{}", error.what());
    return exit_usage;
  }
  if (run.quiet || resumed.quiet || check.quiet || export_quiet || report_quiet || study.quiet || sweep.quiet ||
      optimise.quiet)
    spdlog::set_level(spdlog::level::warn);

  if (run_app->parsed()) return guarded(run.scene, [&run] { return run_command(run); });
  if (resume_app->parsed())
    return guarded(resumed.folder / "scene.toml", [&resumed] { return resume_command(resumed); });
  if (accuracy_app->parsed()) return guarded(study.scene, [&study] { return study_command(study); });
  if (sweep_app->parsed()) return guarded(sweep.scene, [&sweep] { return sweep_command(sweep); });
  if (optimise_app->parsed()) return guarded(optimise.scene, [&optimise] { return optimise_command(optimise); });
  if (check_app->parsed()) return guarded(check.scene, [&check] { return check_command(check); });
  if (report_app->parsed()) return guarded({}, [&reported] { return report_command(reported); });
  if (inspect_app->parsed()) return guarded({}, [&inspected] { return inspect_command(inspected); });
  return guarded({}, [&exported] { return export_command(exported); });
}

} // namespace grandamp

#include "io/commands/commands.hpp"
#include "io/plan_report.hpp"
#include "io/run.hpp"
#include "kernels/dispatch.hpp"
#include "solver/packing.hpp"

namespace grandamp {

int check_command(const CheckArguments& arguments) {
  require_isa(arguments.isa);
  const SceneDocument document = read_scene(arguments.scene, arguments.overrides);
  const Plan plan = make_located_plan(document);
  try {
    place_granules(plan); // what overlaps or does not fit shows only here
  } catch (const SceneError& error) {
    throw SceneError(located(document, error.problems()));
  }
  tell_notes(arguments.scene, plan.notes);

  const std::string isa = arguments.isa.empty() ? kernels::name(kernels::best_available()) : arguments.isa;
  if (arguments.json) {
    tell(plan_json(plan, isa, arguments.threads));
  } else if (!arguments.quiet) {
    tell(plan_text(plan, isa, arguments.threads));
  }
  return exit_done;
}

} // namespace grandamp

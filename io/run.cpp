#include "io/run.hpp"

#include "io/preparation.hpp"
#include "io/run_folder.hpp"

#include <utility>

namespace grandamp {
namespace {

/// Faults found by the solver carry keys alone: adds the document's lines.
template <class Work> auto with_lines(const SceneDocument& document, const Work& work) {
  try {
    return work();
  } catch (const SceneError& error) {
    throw SceneError(located(document, error.problems()));
  }
}

} // namespace

Plan make_located_plan(const SceneDocument& document) {
  Plan plan = with_lines(document, [&] { return make_plan(document.scene); });
  plan.notes = located(document, std::move(plan.notes));
  plan.notes.insert(plan.notes.begin(), document.notes.begin(), document.notes.end());
  return plan;
}

RunResult run_scene(const SceneDocument& document, const std::filesystem::path& folder,
                    const RunSceneOptions& options) {
  const std::vector<Problem> notes = make_located_plan(document).notes; // a bad scene must not cost the folder anything
  if (options.notes && !notes.empty()) options.notes(notes);
  RunFolder files(folder, options.force);
  return run_anew(document, files, options);
}

} // namespace grandamp

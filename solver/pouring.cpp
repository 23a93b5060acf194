#include "solver/pouring.hpp"

#include "solver/errors.hpp"
#include "solver/measures.hpp"
#include "solver/stepper.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grandamp {

namespace {

constexpr double rest_share = 1e-6;         ///< of m g d, mean kinetic energy per granule
constexpr double pouring_restitution = 0.3; ///< falls quickly to rest; what is at rest does not depend on it
constexpr std::int64_t steps_between_looks = 250;
constexpr double longest_pour = 30.0; ///< s

/// The scene while granules fall: a still enclosure, lossy contacts, nothing recorded.
Plan pouring_plan(const Plan& plan) {
  Scene scene = plan.scene;
  scene.structure.reset();
  scene.excitation = {};
  scene.output.energy = false;
  scene.output.window.reset();
  scene.time.step.reset();
  scene.time.error.reset();
  scene.time.adaptive = false;
  scene.time.impact_speed.reset();
  scene.time.steps_per_contact = 8.0;
  scene.time.integrator = Integrator::leapfrog;
  scene.time.precision = Precision::full;
  scene.time.duration = longest_pour;
  scene.verlet = {};
  for (Population& population : scene.populations) population.speed = 0.0;
  // Friction that has no hold at zero slip only makes the way to rest long: the bed would creep for seconds.
  scene.contact.friction = FrictionLaw::none;
  scene.contact.damping = NormalDamping::tsuji;
  const auto made_lossy = [](ContactConstants& constants) {
    constants.friction.reset();
    constants.normal_damping.reset();
    constants.alpha.reset();
    constants.restitution = pouring_restitution;
  };
  made_lossy(scene.contact.granule);
  if (scene.contact.wall) made_lossy(*scene.contact.wall);
  for (PairContact& pair : scene.contact.pairs) made_lossy(pair.constants);
  return make_plan(scene);
}

} // namespace

void pour(const Plan& plan, Placement& placement, kernels::InstructionSet isa, int threads,
          const std::function<void(const PouringProgress&)>& progress, const RunState* so_far) {
  const Plan pouring = pouring_plan(plan);
  Stepper stepper =
      so_far != nullptr ? Stepper(pouring, *so_far, isa, threads) : Stepper(pouring, placement, isa, threads);
  const double gravity = norm(plan.scene.gravity);
  double weight_times_diameter = 0.0;
  for (std::size_t i = 0; i < placement.position.size(); ++i)
    weight_times_diameter += placement.mass[i] * gravity * 2.0 * placement.radius[i];

  PouringProgress now;
  now.save = [&](RunState& state) {
    stepper.save(state);
    state.steps = std::max(pouring.steps, stepper.step_number());
    state.window = pouring.window;
  };
  for (;;) {
    const bool look = stepper.step_number() % steps_between_looks == steps_between_looks - 1;
    const StepRecord& record = stepper.step(look);
    if (look) now.energy = record.kinetic / weight_times_diameter;
    if (now.energy <= rest_share) break; // and is not to be gone on from: the next look would be steps away
    now.time = stepper.time();
    if (progress) progress(now);
    if (look && stepper.step_number() >= pouring.steps)
      throw GuardError(fmt::format(
          "packing: the granules came to no rest in {} s of pouring (mean kinetic energy {:.2g} m g d, wanted {:.0e}); "
          "use packing.kind = \"random\", or give positions",
          longest_pour, now.energy, rest_share));
  }
  const Granules& granules = stepper.granules();
  for (std::uint32_t row = 0; row < granules.count(); ++row) {
    const kernels::PositionRow& p = granules.position[row];
    placement.position[granules.id[row]] = {p.x, p.y, p.z};
  }
}

} // namespace grandamp

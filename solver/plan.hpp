// What would run: everything that follows from a scene before the first granule is placed. `grandamp check` prints it,
// Simulation is built from it.
#pragma once

#include "solver/errors.hpp"
#include "solver/scene.hpp"
#include "solver/step_choice.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// The damper in the numbers its users quote. Entries without meaning for the scene are NaN.
struct DamperNumbers {
  double granule_mass = 0.0;      ///< total, kg
  double mass_ratio = 0.0;        ///< granules over structure
  double fill_fraction = 0.0;     ///< solid volume over the enclosure's
  double clearance = 0.0;         ///< enclosure's height along gravity (or the motion) less the bed's at 60 % solid, m
  double acceleration = 0.0;      ///< dimensionless: peak acceleration of the bare enclosure over g
  double natural_frequency = 0.0; ///< without granules, Hz
  double loaded_frequency = 0.0;  ///< with the granules as added mass, Hz
};

/// The scene, resolved. All quantities SI.
struct Plan {
  Scene scene;
  std::size_t granules = 0;
  double smallest_radius = 0.0;
  double largest_radius = 0.0;
  double mean_radius = 0.0;
  double small_radius = 0.0; ///< up to which granules are in cells of their size (solver/size_cut.hpp)
  double impact_speed = 0.0; ///< closing speed that T_c rests on, m/s
  bool impact_speed_estimated = true;
  double contact_duration = 0.0;         ///< T_c of the stiffest, lightest contact, s; 0 without granules
  std::string time_step_reason;          ///< one sentence: which contact, which speed
  double time_step = 0.0;                ///< s
  std::optional<StepChoice> step_choice; ///< what time.error led to; the scene's integrator is then the one chosen
  std::int64_t steps = 0;
  std::array<double, 2> window{0.0, 0.0}; ///< of the statistics, s
  double skin = 0.0;                      ///< at the start, m
  bool skin_tuned = false;
  double cell = 0.0;                         ///< cell length asked for, m
  std::array<int, 3> grid{1, 1, 1};          ///< cells along x, y, z at the start
  std::size_t memory = 0;                    ///< bytes at most, about
  std::vector<std::string> effects;          ///< chosen: "hertz", "tsuji", ...
  std::vector<std::string> effects_left_out; ///< not in the kernels of this run
  DamperNumbers damper;
  std::vector<Problem> notes; ///< worth telling, not wrong
};

/// Resolves and checks a scene. Throws SceneError with every fault found (keys, no lines).
Plan make_plan(const Scene& scene);

} // namespace grandamp

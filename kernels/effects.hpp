// The effects that a scene can call for, as enums. One set of them is one kernel: what is not in the set is not in its
// instructions.
#pragma once

namespace grandamp::kernels {

enum class Damping { none, tsuji, linear };

/// Coulomb friction needs the granules' spin to know the slip, unless the scene leaves rotation out.
enum class Friction { none, coulomb_without_rotation, coulomb };

/// How far granules differ: all alike; radii or masses differ; the laws of contact differ by population, too.
enum class Variety { alike, sizes, materials };

/// What a step tells beside moving the granules.
enum class Observation {
  none,
  energies,           ///< stored energies and contacts of this step
  ledger,             ///< dissipation by mechanism
  ledger_and_energies ///< both
};

struct ContactEffects {
  Damping damping = Damping::tsuji;
  Friction friction = Friction::coulomb;
  Variety variety = Variety::alike;
  Observation observation = Observation::none;

  constexpr bool rotates() const { return friction == Friction::coulomb; }
  constexpr bool rubs() const { return friction != Friction::none; }
  constexpr bool damped() const { return damping != Damping::none; }
  constexpr bool ledger() const {
    return observation == Observation::ledger || observation == Observation::ledger_and_energies;
  }
  constexpr bool energies() const {
    return observation == Observation::energies || observation == Observation::ledger_and_energies;
  }
};

/// leapfrog: forces see the half-step velocity. verlet: forces see the velocity predicted to the full step.
enum class Integration { leapfrog, verlet };

struct MotionEffects {
  Integration integration = Integration::leapfrog;
  bool rotates = true;
  bool accelerated = true; ///< gravity, or an enclosure that moves
  Observation observation = Observation::none;

  constexpr bool ledger() const {
    return observation == Observation::ledger || observation == Observation::ledger_and_energies;
  }
  constexpr bool energies() const {
    return observation == Observation::energies || observation == Observation::ledger_and_energies;
  }
};

} // namespace grandamp::kernels

// The effects that a scene can call for, as enums. One set of them is one kernel: what is not in the set is not in its
// instructions.
#pragma once

namespace grandamp::kernels {

/// Without tension: a contact only pushes, the damping may not pull at its end.
enum class Damping { none, tsuji, linear, tsuji_without_tension, linear_without_tension };

/// Friction needs the granules' spin to know the slip, unless the scene leaves rotation out. spring: an elastic contact
/// point that slides when it must, with a memory.
enum class Friction { none, coulomb_without_rotation, coulomb, spring_without_rotation, spring };

/// How far granules differ: all alike; radii or masses differ; the laws of contact differ by population, too.
enum class Variety { alike, sizes, materials };

/// What a step tells beside moving the granules.
enum class Observation {
  none,
  energies,           ///< stored energies and contacts of this step
  ledger,             ///< dissipation by mechanism
  ledger_and_energies ///< both
};

/// mixed: positions, motion and what is summed in double, the law of contact between granules in float on twice the
/// lanes. Walls are few, and carry the structure: their law stays in double.
enum class Precision { full, mixed };

struct ContactEffects {
  Damping damping = Damping::tsuji;
  Friction friction = Friction::coulomb;
  Variety variety = Variety::alike;
  Observation observation = Observation::none;
  Precision precision = Precision::full;

  constexpr bool rotates() const { return friction == Friction::coulomb || friction == Friction::spring; }
  constexpr bool rubs() const { return friction != Friction::none; }
  constexpr bool remembers() const {
    return friction == Friction::spring || friction == Friction::spring_without_rotation;
  }
  /// Coulomb's friction is bounded by what the granules' other contacts leave to it.
  constexpr bool counts() const { return rubs() && !remembers(); }
  constexpr bool damped() const { return damping != Damping::none; }
  constexpr bool only_pushes() const {
    return damping == Damping::tsuji_without_tension || damping == Damping::linear_without_tension;
  }
  constexpr bool ledger() const {
    return observation == Observation::ledger || observation == Observation::ledger_and_energies;
  }
  constexpr bool energies() const {
    return observation == Observation::energies || observation == Observation::ledger_and_energies;
  }
};

/// Springs, and contacts that only push, have no kernels in mixed precision.
constexpr bool has_mixed_kernel(ContactEffects e) {
  return !e.remembers() && !e.only_pushes();
}

/// leapfrog: forces see the half-step velocity. verlet: forces see the velocity predicted to the full step.
enum class Integration { leapfrog, verlet };

/// What friction asks of the motion: nothing; to count contacts; and to turn the granules besides.
enum class Rubbing { none, without_rotation, with_rotation };

struct MotionEffects {
  Integration integration = Integration::leapfrog;
  Rubbing rubbing = Rubbing::with_rotation;
  bool accelerated = true; ///< gravity, or an enclosure that moves
  Observation observation = Observation::none;

  constexpr bool rotates() const { return rubbing == Rubbing::with_rotation; }
  constexpr bool counts() const { return rubbing != Rubbing::none; }
  constexpr bool ledger() const {
    return observation == Observation::ledger || observation == Observation::ledger_and_energies;
  }
  constexpr bool energies() const {
    return observation == Observation::energies || observation == Observation::ledger_and_energies;
  }
};

} // namespace grandamp::kernels

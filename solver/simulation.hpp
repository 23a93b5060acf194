// A run, step by step. A Simulation is a value without global state: several can live side by side.
#pragma once

#include "solver/plan.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// Energies by mechanism since t = 0, J. Losses are positive.
struct Ledger {
  double work_in = 0.0; ///< by the excitation: a force, a foundation's motion, or a prescribed one
  double structural_damping = 0.0;
  double normal_granule = 0.0;
  double normal_wall = 0.0;
  double friction_granule = 0.0;
  double friction_wall = 0.0;
};

/// Energies stored, J.
struct StoredEnergy {
  double kinetic = 0.0;       ///< granules, translation and rotation, laboratory frame
  double gravitational = 0.0; ///< granules, from the laboratory height of the enclosure's origin at x = 0
  double elastic = 0.0;       ///< contacts
  double structure = 0.0;     ///< kinetic and spring energy of the host
};

/// The state at one instant: positions and velocities at the same time.
struct Sample {
  double time = 0.0;         ///< s
  double displacement = 0.0; ///< of the enclosure along its direction, m
  double velocity = 0.0;     ///< m/s
  double excitation = 0.0;   ///< force on the structure, N (foundation in motion: K y + c y'; prescribed motion: 0)
  double reaction = 0.0;     ///< of the granules on the enclosure along its direction, N
  Vector3 wall_force{};      ///< of the granules on the enclosure, N; `reaction` is its part along the direction
  StoredEnergy stored;
  std::int64_t contacts = 0; ///< granule and wall contacts
  Ledger ledger;             ///< up to this instant; zeros when the ledger is off
};

/// Granules by id (scene order), in the contract's frames: positions in the enclosure's, velocities in the
/// laboratory's.
struct GranuleTable {
  std::vector<Vector3> position; ///< m
  std::vector<Vector3> velocity; ///< m/s
  std::vector<Vector3> spin;     ///< rad/s
  std::vector<double> radius;    ///< m
  std::vector<std::int32_t> population;
  std::vector<std::int32_t> contacts; ///< with others and with walls, each
};

struct VerletStatistics {
  std::int64_t builds = 0;
  double mean_interval = 0.0;          ///< steps
  double candidates_per_granule = 0.0; ///< mean over builds
  double contacts_per_granule = 0.0;   ///< mean over history samples
  double skin = 0.0;                   ///< in force at the end, m
  std::int64_t audited = 0;            ///< steps at which the list was compared
  std::int64_t missed = 0;             ///< contacts that began unlisted, each once
  std::int64_t missed_pair_steps = 0;  ///< how long, summed
};

struct GuardStatistics {
  double max_overlap = 0.0; ///< over the smaller radius
  double max_speed = 0.0;   ///< of a granule relative to the enclosure, m/s
  double max_closing = 0.0; ///< greatest closing speed met at a contact, m/s
  std::int64_t escaped = 0;
};

/// What an adaptive step came to.
struct StepReviewStatistics {
  std::int64_t refined = 0; ///< steps that were taken in parts
  std::int64_t parts = 1;   ///< the most that a step was taken in
};

/// One cycle of a free vibration.
struct VibrationCycle {
  double start = 0.0;                     ///< s
  double amplitude = 0.0;                 ///< half the peak-to-peak, m
  double peak_kinetic_energy = 0.0;       ///< of the structure, J
  double specific_damping_capacity = 0.0; ///< kinetic energy lost in the cycle over its peak
  double damping_ratio = 0.0;             ///< of the viscous damping that would lose as much
};

/// Of the structure's displacement, over the window.
struct ResponseStatistics {
  double rms_displacement = 0.0;  ///< about zero, every step, m
  double peak_displacement = 0.0; ///< largest |x|, m
  double amplitude = 0.0;         ///< half the peak-to-peak per forcing period (free: per cycle), averaged, m
  bool steady = false;            ///< the amplitude's trend over the window is below its scatter
  std::vector<double> cycle_amplitudes;
  std::vector<VibrationCycle> cycles; ///< free vibration: of the whole run so far
};

class Profile;

struct RunState; // solver/run_state.hpp

/// Granules on their way to their first places, before t = 0.
struct PouringProgress {
  double time = 0.0;   ///< poured so far, s
  double energy = 1.0; ///< mean kinetic energy per granule over m g d, when last looked at; at rest below 1e-6
  /// The exact state, for RunOptions::poured_so_far. Empty while places to pour from, or random ones, are sought.
  std::function<void(RunState&)> save;
};

struct RunOptions {
  int threads = 0; ///< 0: chosen
  std::string isa; ///< "generic", "avx2", "avx512"; empty: the best this machine runs
  /// Called at every step of the pouring, and now and then while places are sought; what it throws ends both.
  std::function<void(const PouringProgress&)> pouring_progress;
  /// Goes on with a pouring by the same bits, as PouringProgress::save told it of the same scene.
  const RunState* poured_so_far = nullptr;
};

class Simulation {
public:
  /// Places the granules (this may pour them for a while) and prepares the first step.
  /// Throws SceneError, GuardError if the packing comes to no rest, or StateError if options.poured_so_far is of
  /// another scene.
  Simulation(const Scene& scene, const RunOptions& options = {});
  /// Goes on where the run that `state` was taken from was, by the same bits: on any number of threads, and on avx2 or
  /// avx512 alike. Nothing is placed or poured. The scene must be that run's; what it says of output intervals may
  /// differ. Throws SceneError, or StateError (solver/run_state.hpp) if the state does not belong to it.
  Simulation(const Scene& scene, const RunState& state, const RunOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  const Plan& plan() const;
  const std::string& isa() const; ///< of the kernels in use
  int threads() const;
  std::int64_t step_number() const; ///< steps done
  double time() const;              ///< step_number * time_step, s
  bool finished() const;            ///< step_number == plan().steps

  /// One step. Throws GuardError.
  void step();
  /// One step, telling the state that it started from. The granules move by the same bits.
  Sample step_and_sample();
  /// The state now; nothing moves.
  Sample sample();
  /// Granules now, velocities synchronised with positions; nothing moves.
  GranuleTable granules();

  VerletStatistics verlet() const;
  GuardStatistics guards() const;
  StepReviewStatistics step_review() const;
  ResponseStatistics response() const; ///< of the steps so far inside the window
  /// Times the phases of the steps to come into `profile` (solver/profile.hpp); null: no more.
  void set_profile(Profile* profile);
  /// Warnings since the last call (deep overlaps, closing speeds above the estimate, an energy balance that the step
  /// does not explain), each told once.
  std::vector<std::string> take_warnings();

  /// The exact state, between two steps; nothing moves.
  RunState state() const;
  /// Lets the run end at another step, not before now. If `window` (s, not before now unless it starts as the present
  /// one does) is left out, the statistics' window becomes the last half of the run, or what can still be had of it: it
  /// goes on from the present one's start, or starts now.
  void end_at(std::int64_t steps, std::optional<std::array<double, 2>> window = {});

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace grandamp

// The step itself, phase by phase: list, walls, structure, then one sweep over the rows. Knows nothing of packings,
// statistics over time or files.
#pragma once

#include "kernels/dispatch.hpp"
#include "solver/audit.hpp"
#include "solver/contact_count.hpp"
#include "solver/enclosure_motion.hpp"
#include "solver/granules.hpp"
#include "solver/guards.hpp"
#include "solver/material.hpp"
#include "solver/packing.hpp"
#include "solver/plan.hpp"
#include "solver/profile.hpp"
#include "solver/rebuild_policy.hpp"
#include "solver/run_state.hpp"
#include "solver/simulation.hpp"
#include "solver/spring_memory.hpp"
#include "solver/step_review.hpp"
#include "solver/team.hpp"
#include "solver/verlet_list.hpp"
#include "solver/walls.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace grandamp {

/// What one step told, about t_n, the instant that it started from.
struct StepRecord {
  EnclosureStep enclosure;
  double reaction = 0.0;                          ///< N
  Vector3 wall_force{0.0, 0.0, 0.0};              ///< on the enclosure, N
  double elastic = 0.0, kinetic = 0.0;            ///< J; with energies
  double spring_granule = 0.0, spring_wall = 0.0; ///< of `elastic`, in tangential springs; with energies
  Vector3 mass_moment{0.0, 0.0, 0.0};             ///< with energies
  std::int64_t contacts = 0;                      ///< with energies
  Ledger dissipated;                              ///< in this step alone; granules' share with the ledger
  Ledger early;                                   ///< what of it falls before t_n; granules' share with energies
  Ledger until;                                   ///< from t = 0 to t_n
};

class Stepper {
public:
  /// The plan must outlive it.
  Stepper(const Plan& plan, const Placement& start, kernels::InstructionSet isa, int threads);
  /// Goes on where the stepper that the state was taken from was, by the same bits. Throws StateError.
  Stepper(const Plan& plan, const RunState& state, kernels::InstructionSet isa, int threads);
  /// Fills in all that a Stepper remembers.
  void save(RunState& state) const;

  /// One step from t_n to t_(n+1). Throws GuardError.
  const StepRecord& step(bool energies);
  const StepReview& review() const noexcept { return review_; }
  /// What a step would tell now; afterwards everything is as before, but for a list that was due being rebuilt.
  /// `mean`, if given, receives the velocities at t_n in the enclosure's frame, by row.
  /// `keep_counts`: the contacts met count as those of the step before.
  StepRecord trial(bool energies, RowArray<kernels::MotionRow>* mean = nullptr, bool keep_counts = false);

  std::int64_t step_number() const noexcept { return step_number_; }
  double time() const noexcept { return static_cast<double>(step_number_) * time_step_; }
  const Granules& granules() const noexcept { return granules_; }
  const EnclosureMotion& motion() const noexcept { return motion_; }
  /// How many others and walls each granule touches now, by id.
  std::vector<std::int32_t> contacts() const { return contacts_by_id(granules_, list_, walls_); }

  VerletStatistics verlet() const;
  const GuardStatistics& guards() const noexcept { return guards_; }
  std::vector<std::string> take_warnings();
  kernels::InstructionSet isa() const noexcept { return isa_; }
  /// Times the phases of the steps to come into `profile`, which must outlive them; null: no more.
  void set_profile(Profile* profile) noexcept { profile_ = profile; }
  int threads() const noexcept { return team_.threads(); }

private:
  /// Sums of one segment, kept apart so that they are added in order.
  struct SegmentResult {
    kernels::ContactResult boundary; ///< pairs with the next segment
    kernels::ContactResult pairs;
    kernels::WallResult walls;
    kernels::MotionResult motion;

    std::array<kernels::ContactResult*, 3> contacts() { return {&walls, &boundary, &pairs}; }
  };
  struct Kernels {
    kernels::PairKernel* pair = nullptr;
    kernels::WallKernel* plane = nullptr;
    kernels::WallKernel* side = nullptr;
    kernels::MotionKernel* motion = nullptr;
  };

  Stepper(const Plan& plan, bool same_sizes, kernels::InstructionSet isa, int threads);
  void place(const Placement& start);
  void restore_granules(const RunState& state);
  void restore_list(const RunState& state);
  void restore_springs(const RunState& state);
  std::vector<double> constants() const;
  void choose_kernels();
  void choose_mobility();
  void take_half_step_back();
  const Kernels& kernels_for(bool energies) const;

  /// Moves the granules along their half-step velocities for `time` (s).
  void drift(double time);
  void take_part(bool energies);
  const EnclosureMotion& mover() const { return level_ == 0 ? motion_ : motion_in_parts_[level_ - 1]; }
  const StepRecord& step_in_parts(std::size_t level, bool energies);
  GuardView view() const { return {plan_, granules_, list_, walls_, step_number_, time_step_, part_}; }

  void rebuild_if_due();
  void rebuild();
  double largest_laboratory_speed() const;
  void audit_if_due();
  double wall_forces(const Kernels& kernels); ///< the reaction along the enclosure's direction, N
  Vector3 wall_force() const;                 ///< on the enclosure, N, of the walls' kernels just run
  /// Whether the pairs of a segment with the next one can wait until the segment is swept: one thread sweeps both, the
  /// next one later. Else they are worked off before the sweep, since the rows of neither may have moved.
  bool crosses_in_sweep(std::size_t segment) const noexcept;
  void boundary_forces(const Kernels& kernels);
  void boundary_forces_of(std::size_t segment, std::size_t block, const Kernels& kernels,
                          const kernels::PairArguments& shared);
  void sweep(const Kernels& kernels, const Vector3& kick, const Vector3& frame_velocity);
  StepRecord collect(double reaction, const EnclosureStep& enclosure);
  void age_list(double max_speed, double time);
  void watch(double sum_speed_squared);
  StepRecord advance(bool energies);
  Ledger ledger_at(const StepRecord& record) const;
  double approach_share() const;           ///< how much nearer two granules may have come since the list, over the skin
  kernels::PairArguments pair_arguments(); ///< of all segments, but for their scratch
  bool remembers() const noexcept { return contact_effects_.remembers(); }
  /// Rows of the springs of a list from its entry `first` on, and their laws.
  kernels::SpringArguments spring_arguments(std::size_t segment, SpringMemory::Rows& rows, std::size_t first,
                                            const std::vector<kernels::SpringLawRow>& laws);

  const Plan& plan_;
  double time_step_;
  double part_; ///< time_step_, or the part of it that is being taken, s
  kernels::InstructionSet isa_;
  Team team_;
  std::vector<Wall> walls_;
  Vector3 size_;
  ContactTable contacts_;
  bool same_sizes_ = true; ///< granules of one radius and one mass
  kernels::ContactEffects contact_effects_;
  kernels::MotionEffects motion_effects_;
  Kernels plain_, with_energies_;
  VerletList::Search search_;
  std::vector<kernels::LawRow> pair_laws_, wall_laws_;
  std::vector<kernels::SpringLawRow> pair_spring_laws_, wall_spring_laws_;
  double friction_cap_ = 0.0;
  double enclosure_inverse_mass_ = 0.0; ///< the largest that the structure shows, 1/kg
  /// By wall: the line along which the structure yields, and how much, 1/kg.
  struct Mobility {
    Vector3 direction{};
    double inverse_mass = 0.0;
  };
  std::vector<Mobility> wall_mobility_;
  double friction_inverse_mass_ = 0.0;
  double closing_limit_ = 0.0;
  std::vector<EnclosureMotion> motion_in_parts_; ///< by level, from 1
  bool touch_ahead_ = false;                     ///< the rows exceed the caches

  // The state of the run.
  std::int64_t step_number_ = 0;
  Granules granules_;
  VerletList list_;
  SpringMemory springs_; ///< spring friction only
  ListAge age_;
  SkinTuner tuner_;
  double skin_ = 0.0;
  StepReview review_;
  EnclosureMotion motion_;
  std::size_t level_ = 0;        ///< of the part that is being taken
  std::int64_t part_number_ = 0; ///< of the step, in parts of its own length
  std::int64_t kick_number_ = 0; ///< since the stepper was made: what springs tell the last step by
  EnclosureState enclosure_;
  Ledger ledger_; ///< from t = 0 to t_(n-1/2)
  Audit audit_;
  GuardStatistics guards_;
  std::int64_t builds_ = 0, build_steps_ = 0;
  double candidates_sum_ = 0.0;
  RowArray<kernels::PositionRow> built_at_; ///< displacement policy

  StepRecord record_;
  Profile* profile_ = nullptr;
  std::vector<SegmentResult> results_;
  std::vector<std::string> warnings_;
  bool audit_due_ = false; ///< not yet in this step
  bool warned_overlap_ = false, warned_closing_ = false;
};

} // namespace grandamp

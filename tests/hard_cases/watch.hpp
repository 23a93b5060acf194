// What must hold in every hard case, watched through the whole run: finite, inside, passive, closed, balanced,
// complete.
#pragma once

#include "tests/hard_cases/choices.hpp"
#include "tests/support/runs.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace grandamp::test {

/// Figures of one run, each the worst that was seen.
struct Figures {
  std::size_t granules = 0;
  std::int64_t steps = 0;
  std::int64_t not_finite = 0; ///< values of a granule's state, over all looks
  double nearest_wall = 1.0;   ///< least distance of a centre from a wall, over the radius; below 0: outside
  double rise = 0.0;           ///< of the energy less the work put in, over the largest kinetic and elastic energy
  double allowed_rise = 0.0;   ///< what the integrator does to one elastic contact at this step
  double residual = 0.0;       ///< of the energy balance, over its largest term
  double momentum = 0.0;       ///< change that no impulse explains, over momenta and impulses
  double angular = 0.0;        ///< change about the centre of mass in stretches without walls, over its parts
  std::int64_t free_looks = 0; ///< how many such stretches there were
  std::int64_t audited = 0, missed = 0, missed_pair_steps = 0;
  double max_overlap = 0.0;     ///< over the smaller radius
  double max_closing = 0.0;     ///< m/s
  double assumed_closing = 0.0; ///< m/s, that the step rests on
  double microseconds_per_step = 0.0;
  bool warned_balance = false; ///< the run told of an energy balance that the step does not explain
  bool warned_closing = false; ///< the run told of closing speeds above the one assumed
  std::string stopped;         ///< what a guard said, if one ended the run
};

struct WatchOptions {
  std::int64_t looks = 100;                 ///< at all granules, spread over the run
  std::int64_t audit_every = 200;           ///< steps between all-pairs searches
  std::int64_t audit_every_if_missing = 10; ///< the same, where the policy may miss contacts
  std::int64_t sample_every = 1;            ///< energies, every so many steps; above 1 momentum is not balanced
  /// Sees every look, the first and the last instant among them.
  std::function<void(const GranuleTable&, const Sample&)> on_look;
};

/// What the integrator does to the energy of one elastic contact while it lasts.
double allowed_rise(const Choice& choice);

/// How far the ledger of a single contact may be off while it lasts: kinetic and elastic energy are those of positions
/// and velocities at one instant, to second order in the step.
inline double residual_of_a_contact(const Choice& choice) {
  return choice.steps_per_contact < 16.0 ? 0.02 : 0.005;
}

/// Runs the scene to its end, or to a guard.
Figures watch(Scene scene, const Choice& choice, const WatchOptions& options = {});

/// Bounds that a case states for itself; the others are the same for all.
struct Bounds {
  double residual = 0.01; ///< over many contacts; one contact's may be more (residual_of_a_contact)
  double momentum = 1.0e-10;
  double angular = 1.0e-10;
  bool rise = true;      ///< whether the energy is held to allowed_rise
  bool may_stop = false; ///< whether a guard may end a run whose list misses nothing
};

/// Runs of one case: checks each, prints its figures as a row of a table, and at the end the worst of all.
class CaseReport {
public:
  explicit CaseReport(std::string name) : name_(std::move(name)) {}
  CaseReport(const CaseReport&) = delete;
  CaseReport& operator=(const CaseReport&) = delete;
  ~CaseReport();

  void add(const Choice& choice, const Figures& figures, const Bounds& bounds = {}, const std::string& note = {});
  /// A line of its own under the case's rows.
  void remark(const std::string& text);
  std::int64_t granule_steps() const { return granule_steps_; }

private:
  std::string name_;
  std::int64_t granule_steps_ = 0;
  std::size_t runs_ = 0;
  std::size_t stopped_ = 0;
  Figures worst_;
  std::vector<std::string> misses_;
};

} // namespace grandamp::test

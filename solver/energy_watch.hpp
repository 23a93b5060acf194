// The energy balance, watched as the run goes: what is left of it against what the step can explain.
#pragma once

#include "solver/plan.hpp"
#include "solver/simulation.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace grandamp {

class EnergyWatch {
public:
  /// A plain struct: all of it is state of the run.
  struct State {
    std::int64_t samples = 0;   ///< seen
    double first = 0.0;         ///< stored energy less the work put in, with the losses, of the first one, J
    double gravitational = 0.0; ///< of the first one, J
    double largest = 0.0;       ///< term of the balance so far, J
    std::int64_t beyond = 0;    ///< samples in a row that nothing explains
    bool warned = false;
  };

  /// Share of the largest term that a balance may be off by when the fastest contact is followed by so many steps: a
  /// single hit's ledger, measured over restitutions, speeds and angles, is off by up to 2.4 / steps^2 (3.8 % at 8,
  /// 0.8 % at 16); twice that leaves nothing to chance.
  static double explained(double steps_per_contact);

  /// Takes a sample in; a warning if the balance has left what the step explains, once in a run. Some samples in a row
  /// must say so: at the beginning of a run all terms are tiny.
  std::optional<std::string> note(const Sample& sample, const Plan& plan, const GuardStatistics& guards);

  const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }

private:
  State state_;
};

} // namespace grandamp

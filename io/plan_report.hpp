// A plan in words and as JSON: what `grandamp check` tells.
#pragma once

#include "solver/plan.hpp"

#include <string>

namespace grandamp {

/// What the estimate rests on, and what comes out.
struct WallTimeEstimate {
  double seconds = 0.0;
  std::string basis; ///< one sentence
};

/// From rates measured beforehand, not from running anything: right within a factor of three. threads = 0: one.
WallTimeEstimate estimate_wall_time(const Plan& plan, const std::string& isa, int threads);

std::string plan_text(const Plan& plan, const std::string& isa, int threads);
std::string plan_json(const Plan& plan, const std::string& isa, int threads);

} // namespace grandamp

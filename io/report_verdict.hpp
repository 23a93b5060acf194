// Whether the numbers of a run are to be believed. Internal to io.
#pragma once

#include "io/report_run.hpp"

#include <string>
#include <vector>

namespace grandamp::report {

/// Limits of what the page takes for granted.
inline constexpr double residual_doubtful = 0.01; ///< of the energy balance
inline constexpr double residual_wrong = 0.05;
inline constexpr double fewest_periods = 10.0; ///< in the window
inline constexpr double fewest_rows = 20.0;    ///< of the histories in a period

enum class Doubt {
  none,    ///< worth knowing
  some,    ///< read with care
  serious, ///< not to be relied on
};

struct Caution {
  Doubt doubt = Doubt::none;
  std::string what; ///< what was found
  std::string so;   ///< what it means, or what to do
};

/// The gravest first.
std::vector<Caution> cautions_of(const RunFacts& run);
/// The verdict and its reasons, at the top of the page.
void add_verdict(Page& page, const RunFacts& run);

} // namespace grandamp::report

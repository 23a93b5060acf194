// What a forced run says of damping: closed forms beside it, energy per cycle and what an engineer makes of it.
// Internal to io.
#pragma once

#include "io/sweep_grid.hpp"

namespace grandamp {

/// Whether the structure is forced harmonically, so that the closed forms hold.
bool is_forced_structure(const CasePoint& point);

/// Amplitude of the steady response without granules, their mass `added_mass` (kg) fixed to the structure, m:
/// a = F / sqrt((K - (M + m) w^2)^2 + (c w)^2).
double closed_form_amplitude(const CasePoint& point, double added_mass, double frequency);

/// Adds to the numbers of a run that is done, from its energy ledger over the whole periods of the statistics' window:
/// - damping.acceleration: (2 pi f)^2 a / g, the dimensionless peak acceleration, with a the amplitude;
/// - damping.normal_granule, ... and damping.dissipated: D, what contacts take in a cycle, J;
/// - damping.loss_factor: D / (2 pi U), U = 1/2 M (2 pi f a)^2 of the structure; where the enclosure's motion is
///   prescribed, of the granules' mass moving with it;
/// - damping.ratio: of the viscous damper that would take as much, D / (2 pi (2 pi f) a^2 sqrt(K M)); with a structure.
/// Nothing where there is no harmonic motion, no ledger or no whole period in the window. Throws FileError.
void add_damping(CaseRun& run, const CasePoint& point);

} // namespace grandamp

// What is written of a free vibration: damping by cycle and amplitude, as a table and a picture.
#pragma once

#include "solver/scene.hpp"
#include "solver/simulation.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

/// Comma-separated with a header row, a cycle per row, 17 significant digits: cycle (from 1), start (s), amplitude (m),
/// peak_kinetic_energy (J), specific_damping_capacity, damping_ratio.
std::string decay_csv(const std::vector<VibrationCycle>& cycles);

/// Damping ratio against amplitude beside the structure's own (of the bare structure), and amplitude against time. An
/// SVG document.
std::string decay_svg(const std::vector<VibrationCycle>& cycles, const std::string& title, const Structure& bare);

/// The cycles that a summary.json tells of. Throws FileError; UsageError if the run was no free vibration, or too short
/// for a cycle.
std::vector<VibrationCycle> read_cycles(const std::filesystem::path& summary);

} // namespace grandamp

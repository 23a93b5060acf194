// What a structure of several degrees of freedom shows: its natural frequencies, and the mass that the enclosure has.
#pragma once

#include "solver/driven_structure.hpp"
#include "solver/scene.hpp"

#include <array>
#include <vector>

namespace grandamp {

inline bool has_several_modes(const Scene& scene) {
  return scene.structure && scene.structure->modes.size > 0;
}

/// The matrices as such.
LinearStructure linear_structure(const SeveralModes& modes);

struct ModalNumbers {
  std::vector<double> frequency;     ///< natural frequencies without damping, Hz, ascending
  std::vector<double> damping_ratio; ///< of each, from the damping matrix's diagonal in its modes
  std::array<double, 9>
      mobility{};                ///< attachment M^-1 attachment^T, 3 x 3, 1/kg: what an impulse on the enclosure does
  double enclosure_mass = 0.0;   ///< the least that it shows in any direction, kg
  double fastest_decay = 0.0;    ///< largest of damping over mass, 1/s
  double loaded_frequency = 0.0; ///< the lowest, with the added mass carried by the enclosure, Hz
};

/// From the generalised eigenvalues of stiffness and mass.
ModalNumbers modal_numbers(const SeveralModes& modes, double added_mass = 0.0);

/// Mass, stiffness and damping with the mass that the enclosure shows and the fastest of the structure's frequencies
/// and decays: what a step must follow. Of one degree of freedom, its own.
struct Oscillator {
  double mass = 0.0;
  double stiffness = 0.0;
  double damping = 0.0;
};
Oscillator fastest_oscillator(const Structure& structure);

/// What is wrong with the matrices, by key; empty: nothing.
struct MatrixFault {
  std::string key; ///< after "structure.modes."
  std::string message;
  std::string allowed;
};
std::vector<MatrixFault> faults_of(const SeveralModes& modes);

} // namespace grandamp

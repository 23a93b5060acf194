// A frequency response as a universal file (UFF, "unv"): what modal-test programs read.
#pragma once

#include "io/frequency_response.hpp"
#include "solver/scene.hpp"

#include <ctime>
#include <string>

namespace grandamp {

struct UniversalHeader {
  std::string title;       ///< of the run; what is not ASCII becomes "?"
  std::string program;     ///< that writes it, with its version
  Vector3 direction{};     ///< of force and displacement, unit vector
  std::time_t written = 0; ///< UTC
};

/// Datasets 151 (header), 164 (units: SI), 15 (the one node) and, in ASCII, 58: the frequency response (function type
/// 4, complex, double precision) and, with more than one average, the coherence (type 6). After the descriptions that
/// the University of Cincinnati's Structural Dynamics Research Laboratory publishes.
std::string universal_file(const FrequencyResponse& response, const UniversalHeader& header);

/// 1, 2, 3 along x, y, z, negative against; 0 (a scalar) in any other direction.
int universal_direction(const Vector3& direction);

} // namespace grandamp

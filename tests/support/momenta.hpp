// Momentum and angular momentum of all granules of a table.
#pragma once

#include "tests/support/runs.hpp"

#include <vector>

namespace grandamp::test {

struct Momenta {
  Vector3 linear{}, angular{};                    ///< kg m/s; kg m^2/s about the centre of mass, spins included
  double linear_scale = 0.0, angular_scale = 0.0; ///< sums of the parts' sizes
};

/// `masses` by id, kg.
inline Momenta momenta(const GranuleTable& granules, const std::vector<double>& masses) {
  Momenta all;
  Vector3 centre{};
  double total = 0.0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    total += masses[i];
    for (std::size_t k = 0; k < 3; ++k) {
      centre[k] += masses[i] * granules.position[i][k];
      all.linear[k] += masses[i] * granules.velocity[i][k];
    }
    all.linear_scale += masses[i] * length(granules.velocity[i]);
  }
  for (double& component : centre) component /= total;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vector3 orbital = cross(difference(granules.position[i], centre), granules.velocity[i]);
    const double inertia = 0.4 * masses[i] * granules.radius[i] * granules.radius[i];
    for (std::size_t k = 0; k < 3; ++k) all.angular[k] += masses[i] * orbital[k] + inertia * granules.spin[i][k];
    all.angular_scale += masses[i] * length(orbital) + inertia * length(granules.spin[i]);
  }
  return all;
}

} // namespace grandamp::test

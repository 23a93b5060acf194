// --keep total_mass: what follows so that the granules' total mass is that of the scene. Internal to io.
#pragma once

#include "io/scene_file.hpp"
#include "io/vary.hpp"

#include <string>
#include <vector>

namespace grandamp {

/// The total mass of each population stays the scene's, to rounding:
/// - radius, density or mass varied: the count follows, rounded, and then the density (or the mass per granule, where
///   the scene gives that) takes up what rounding left, at most 0.5 / count of it;
/// - count varied: the radius follows, at the scene's density;
/// - count and radius varied: the density (or mass per granule) follows.
class KeptMass {
public:
  /// Throws UsageError: nothing of the kind is varied, or nothing is left that could follow.
  KeptMass(const SceneDocument& document, const std::vector<std::string>& keys);

  /// "KEY=VALUE" for what follows from the values of `keys`, in their order. Throws UsageError.
  std::vector<std::string> overrides(const std::vector<VaryValue>& values) const;

private:
  struct Kept {
    std::size_t population = 0;
    std::string prefix; ///< "granules.0."
    double total = 0.0; ///< kg
    double density = 0.0, radius = 0.0;
    bool by_mass = false;                                         ///< the scene gives the mass per granule
    int count = -1, radius_key = -1, density_key = -1, mass = -1; ///< which of the keys; -1: not varied
  };
  static std::vector<std::string> following(const Kept& kept, const std::vector<VaryValue>& values);

  std::vector<Kept> kept_;
};

} // namespace grandamp

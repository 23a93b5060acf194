// A small dense bed in the oracle's form and in the kernels' rows, and every machine and set of effects to try on it.
#pragma once

#include "kernels/dispatch.hpp"
#include "kernels/reference.hpp"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace grandamp::test {

using namespace grandamp::kernels;

inline constexpr double step = 5.0e-6; ///< s

inline std::vector<InstructionSet> machines() {
  std::vector<InstructionSet> all;
  for (const InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512})
    if (available(set)) all.push_back(set);
  return all;
}

inline std::vector<ContactEffects> contact_effects() {
  std::vector<ContactEffects> all;
  for (const auto damping : {kernels::Damping::none, kernels::Damping::tsuji, kernels::Damping::linear})
    for (const auto friction : {Friction::none, Friction::coulomb_without_rotation, Friction::coulomb})
      for (const auto variety : {Variety::alike, Variety::sizes, Variety::materials})
        for (const auto observation :
             {Observation::none, Observation::energies, Observation::ledger, Observation::ledger_and_energies})
          all.push_back({damping, friction, variety, observation});
  return all;
}

inline std::string describe(InstructionSet set, ContactEffects e) {
  return std::string(name(set)) + ", damping " + std::to_string(static_cast<int>(e.damping)) + ", friction " +
         std::to_string(static_cast<int>(e.friction)) + ", variety " + std::to_string(static_cast<int>(e.variety)) +
         ", observation " + std::to_string(static_cast<int>(e.observation));
}

/// Granules in the oracle's form and in the kernels' rows.
struct Bed {
  std::vector<reference::Granule> granules;
  std::vector<PositionRow> position;
  std::vector<MotionRow> motion;
  std::vector<ForceRow> force, friction_granule, friction_wall;
  std::vector<DampingRow> damping_granule, damping_wall;
  std::vector<std::uint8_t> population;
  std::size_t populations = 3;
  std::vector<reference::Law> laws; ///< populations x populations; of walls: the first row
  std::vector<LawRow> rows;

  std::size_t count() const { return granules.size(); }
  const reference::Law& law(std::size_t i, std::size_t j, Variety variety) const {
    return variety == Variety::materials ? laws[population[i] * populations + population[j]] : laws.front();
  }
  const reference::Law& wall_law(std::size_t i, Variety variety) const {
    return variety == Variety::materials ? laws[population[i]] : laws.front();
  }
  GranuleArrays arrays() {
    GranuleArrays a;
    a.position = position.data();
    a.motion = a.predicted = motion.data();
    a.force = force.data();
    a.population = population.data();
    a.damping_granule = damping_granule.data();
    a.damping_wall = damping_wall.data();
    a.friction_granule = friction_granule.data();
    a.friction_wall = friction_wall.data();
    a.ghost = static_cast<std::uint32_t>(count());
    return a;
  }
};

struct Random {
  std::mt19937_64 engine;
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  reference::Vector vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

/// A slab of granules on a jittered lattice so tight that neighbours overlap by up to some percent of a radius; some of
/// them with exactly no slip among them.
inline Bed make_bed(ContactEffects effects, unsigned seed) {
  Bed bed;
  Random random{std::mt19937_64(seed)};
  const double radius = 1.5e-3;
  const int across = 4, high = 3;
  for (int z = 0; z < high; ++z)
    for (int y = 0; y < across; ++y)
      for (int x = 0; x < across; ++x) {
        reference::Granule g;
        const reference::Vector jitter = random.vector(0.04 * radius);
        const double pitch = 1.96 * radius;
        const double start = 0.98 * radius;
        g.position = {start + pitch * x + jitter[0], start + pitch * y + jitter[1], start + pitch * z + jitter[2]};
        g.radius = radius;
        g.mass = 1.7e-5;
        if (effects.variety != Variety::alike) {
          g.radius *= random(0.92, 1.06);
          g.mass *= random(0.2, 5.0);
        }
        if (z < 2) { // the top layer rests: no slip at all
          const double fast = x % 2 ? 2.0 : 0.01;
          g.velocity = random.vector(fast);
          g.spin = random.vector(fast / radius);
        }
        bed.granules.push_back(g);
        bed.population.push_back(static_cast<std::uint8_t>(random.engine() % bed.populations));
      }
  for (std::size_t a = 0; a < bed.populations; ++a)
    for (std::size_t b = 0; b < bed.populations; ++b) {
      reference::Law law;
      const double differ = effects.variety == Variety::materials ? 1.0 + 0.3 * static_cast<double>(a + b) : 1.0;
      law.stiffness_coefficient = 2.6e8 * differ;
      law.alpha = 0.077 * differ;
      law.normal_damping = 0.2 * differ;
      law.friction = 0.3 * differ;
      law.damping = effects.damping == kernels::Damping::tsuji    ? reference::Damping::tsuji
                    : effects.damping == kernels::Damping::linear ? reference::Damping::linear
                                                                  : reference::Damping::none;
      law.coulomb = effects.friction != Friction::none;
      law.rotation = effects.friction == Friction::coulomb;
      bed.laws.push_back(law);
      bed.rows.push_back({law.stiffness_coefficient,
                          law.damping == reference::Damping::linear ? law.normal_damping : law.alpha, law.friction,
                          0.0});
    }
  const std::size_t count = bed.count();
  for (const reference::Granule& g : bed.granules) {
    bed.position.push_back({g.position[0], g.position[1], g.position[2], g.radius});
    bed.motion.push_back({{g.velocity[0], g.velocity[1], g.velocity[2]},
                          1.0 / g.mass,
                          {g.radius * g.spin[0], g.radius * g.spin[1], g.radius * g.spin[2]},
                          1.0 / g.radius});
  }
  for (int ghost = 0; ghost < 2; ++ghost) {
    bed.position.push_back({1.0e3 * (ghost + 1), 1.0e3, 1.0e3, radius});
    bed.motion.push_back({{0.0, 0.0, 0.0}, 1.0 / 1.7e-5, {0.0, 0.0, 0.0}, 1.0 / radius});
    bed.population.push_back(0);
  }
  bed.force.resize(count + 2);
  bed.friction_granule.resize(count + 2);
  bed.friction_wall.resize(count + 2);
  bed.damping_granule.resize(count + 2);
  bed.damping_wall.resize(count + 2);
  return bed;
}

} // namespace grandamp::test

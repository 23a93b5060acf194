// A small dense bed in the oracle's form and in the kernels' rows, and every machine and set of effects to try on it.
#pragma once

#include "kernels/dispatch.hpp"
#include "kernels/reference.hpp"

#include <algorithm>
#include <cmath>
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
  for (const auto damping : {kernels::Damping::none, kernels::Damping::tsuji, kernels::Damping::linear,
                             kernels::Damping::tsuji_without_tension, kernels::Damping::linear_without_tension})
    for (const auto friction : {Friction::none, Friction::coulomb_without_rotation, Friction::coulomb,
                                Friction::spring_without_rotation, Friction::spring})
      for (const auto variety : {Variety::alike, Variety::sizes, Variety::materials})
        for (const auto observation :
             {Observation::none, Observation::energies, Observation::ledger, Observation::ledger_and_energies})
          all.push_back({damping, friction, variety, observation});
  return all;
}

/// Those that have kernels in mixed precision, in that.
inline std::vector<ContactEffects> mixed_effects() {
  std::vector<ContactEffects> all;
  for (ContactEffects effects : contact_effects())
    if (has_mixed_kernel(effects)) {
      effects.precision = Precision::mixed;
      all.push_back(effects);
    }
  return all;
}

inline std::string describe(InstructionSet set, ContactEffects e) {
  return std::string(name(set)) + ", damping " + std::to_string(static_cast<int>(e.damping)) + ", friction " +
         std::to_string(static_cast<int>(e.friction)) + ", variety " + std::to_string(static_cast<int>(e.variety)) +
         ", observation " + std::to_string(static_cast<int>(e.observation)) +
         (e.precision == Precision::mixed ? ", mixed" : "");
}

/// Granules in the oracle's form and in the kernels' rows.
struct Bed {
  std::vector<reference::Granule> granules;
  std::vector<PositionRow> position;
  std::vector<MotionRow> motion;
  std::vector<ForceRow> force, friction_wall, friction_wall_before;
  std::vector<LossRow> loss;
  std::vector<LastStepRow> last_step;
  std::vector<DampingRow> damping_wall, damping_wall_before;
  std::vector<std::uint8_t> population, touches_wall, touched_wall_before;
  std::size_t populations = 3;
  std::vector<reference::Law> laws; ///< populations x populations; of walls: the first row
  std::vector<LawRow> rows;
  std::vector<SpringLawRow> spring_rows;
  std::vector<MotionRow> arrival; ///< velocities that brought the granules here, where these are not `motion`

  std::size_t count() const { return granules.size(); }
  double largest_radius() const {
    double largest = 0.0;
    for (const reference::Granule& granule : granules) largest = std::max(largest, granule.radius);
    return largest;
  }
  const reference::Law& law(std::size_t i, std::size_t j, Variety variety) const {
    return variety == Variety::materials ? laws[population[i] * populations + population[j]] : laws.front();
  }
  const reference::Law& wall_law(std::size_t i, Variety variety) const {
    return variety == Variety::materials ? laws[population[i]] : laws.front();
  }
  GranuleArrays arrays() {
    GranuleArrays a;
    a.position = position.data();
    a.motion = arrival.empty() ? motion.data() : arrival.data();
    a.predicted = motion.data();
    a.force = force.data();
    a.population = population.data();
    a.loss = loss.data();
    a.last_step = last_step.data();
    a.wall_loss = {damping_wall.data(), friction_wall.data(), touches_wall.data()};
    a.wall_loss_before = {damping_wall_before.data(), friction_wall_before.data(), touched_wall_before.data()};
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
        g.touching = static_cast<int>(random.engine() % (bed.granules.size() == 5 ? 100 : 6));
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
      law.tangential_stiffness_coefficient = 2.1e8 * differ;
      law.tangential_damping = 0.02 * differ;
      const bool linear =
          effects.damping == kernels::Damping::linear || effects.damping == kernels::Damping::linear_without_tension;
      law.damping = linear                                      ? reference::Damping::linear
                    : effects.damping == kernels::Damping::none ? reference::Damping::none
                                                                : reference::Damping::tsuji;
      if (effects.only_pushes()) { // strong enough to pull now and then
        law.tension = false;
        law.alpha *= 20.0;
        law.normal_damping *= 10.0;
      }
      law.spring = effects.remembers();
      law.coulomb = effects.rubs() && !law.spring;
      law.rotation = effects.rotates();
      bed.laws.push_back(law);
      bed.rows.push_back({law.stiffness_coefficient,
                          law.damping == reference::Damping::linear ? law.normal_damping : law.alpha, law.friction,
                          0.0});
      bed.spring_rows.push_back({law.tangential_stiffness_coefficient, law.tangential_damping, {0.0, 0.0}});
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
  for (std::size_t i = 0; i < count; ++i)
    bed.force[i].friction_share = 1.0 / (1.0 + std::max(bed.granules[i].touching, 1));
  bed.loss.resize(count + 2);
  bed.last_step.resize(count + 2);
  bed.friction_wall.resize(count + 2);
  bed.damping_wall.resize(count + 2);
  bed.friction_wall_before.resize(count + 2);
  bed.damping_wall_before.resize(count + 2);
  bed.touches_wall.resize(count + 2);
  bed.touched_wall_before.resize(count + 2);
  return bed;
}

/// Springs that contacts remember, entry by entry of a list: a third of them fresh, a third out of touch for long.
struct Springs {
  std::vector<reference::Spring> before;
  std::vector<SpringRow> rows;
  std::vector<std::uint32_t> touched, slots;
  static constexpr std::uint32_t now = 1000;

  explicit Springs(std::size_t entries) : before(entries), rows(entries), touched(entries, 0), slots(contact_scratch) {
    for (auto& row : rows) row = {};
  }
  void load(std::size_t entry, double overlap, double reduced_radius, Random& random) {
    const double then = overlap * random(0.3, 1.6);
    const reference::Vector force = random.vector(0.7);
    const auto kind = random.engine() % 3;
    if (kind == 0) return;
    rows[entry] = {{force[0], force[1], force[2]}, std::sqrt(reduced_radius * then)};
    touched[entry] = kind == 1 ? now - 1 : now - 7;
    if (kind == 1) before[entry] = {force, then};
  }
  SpringArguments arguments(const Bed& bed) {
    SpringArguments a;
    a.rows = rows.data();
    a.touched = touched.data();
    a.slots = slots.data();
    a.now = now;
    a.before = now - 1;
    a.time_step = step;
    a.law = bed.spring_rows.front();
    a.laws = bed.spring_rows.data();
    return a;
  }
};

/// Other velocities than the bed's own for having come here.
inline void arrive_otherwise(Bed& bed, unsigned seed) {
  Random random{std::mt19937_64(seed)};
  bed.arrival = bed.motion;
  for (MotionRow& row : bed.arrival)
    for (int k = 0; k < 3; ++k) {
      row.velocity[k] += random(-0.3, 0.3);
      row.surface_spin[k] += random(-0.3, 0.3);
    }
}

inline reference::Arrival arrival_of(const Bed& bed, std::size_t i, std::size_t j) {
  reference::Arrival arrival;
  for (std::size_t k = 0; k < 3; ++k) {
    arrival.velocity_i[k] = bed.arrival[i].velocity[k];
    arrival.velocity_j[k] = bed.arrival[j].velocity[k];
    arrival.spin_i[k] = bed.arrival[i].surface_spin[k] / bed.granules[i].radius;
    arrival.spin_j[k] = bed.arrival[j].surface_spin[k] / bed.granules[j].radius;
  }
  return arrival;
}

} // namespace grandamp::test

// Every kernel of every instruction set that this machine runs, in every set of effects, against the scalar oracle on
// random contacts.
#include "kernels/dispatch.hpp"
#include "kernels/reference.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace grandamp;
using namespace grandamp::kernels;

namespace {

constexpr double step = 5.0e-6;

std::vector<InstructionSet> machines() {
  std::vector<InstructionSet> all;
  for (const InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512})
    if (available(set)) all.push_back(set);
  return all;
}

std::vector<ContactEffects> contact_effects() {
  std::vector<ContactEffects> all;
  for (const auto damping : {kernels::Damping::none, kernels::Damping::tsuji, kernels::Damping::linear})
    for (const auto friction : {Friction::none, Friction::coulomb_without_rotation, Friction::coulomb})
      for (const auto variety : {Variety::alike, Variety::sizes, Variety::materials})
        for (const auto observation :
             {Observation::none, Observation::energies, Observation::ledger, Observation::ledger_and_energies})
          all.push_back({damping, friction, variety, observation});
  return all;
}

std::string describe(InstructionSet set, ContactEffects e) {
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
Bed make_bed(ContactEffects effects, unsigned seed) {
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

/// What the oracle adds up for each granule, and the size of what it added (for the tolerance).
struct Expected {
  struct Sum {
    reference::Vector value{};
    double size = 0.0;
    void add(double s, const reference::Vector& v) {
      for (std::size_t k = 0; k < 3; ++k) {
        value[k] += s * v[k];
        size += std::abs(v[k]);
      }
    }
  };
  std::vector<Sum> force, turn, damping, rubbing;
  double elastic = 0.0, max_overlap = 0.0, max_closing = 0.0;
  std::int64_t contacts = 0;
  Sum total; ///< on the granules

  explicit Expected(std::size_t count) : force(count), turn(count), damping(count), rubbing(count) {}
};

/// Largest difference of the rows from what is expected, over its size. The overlap is a difference of lengths a
/// hundred times its size, so some digits are lost in it by any program.
double error_of(const std::vector<Expected::Sum>& expected, const double* rows, std::size_t stride) {
  double largest = 0.0;
  for (const Expected::Sum& sum : expected) largest = std::max(largest, sum.size);
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double error = std::abs(rows[i * stride + k] - expected[i].value[k]);
      const double size = expected[i].size + 1.0e-6 * largest + std::numeric_limits<double>::min();
      if (!(error / size <= worst)) worst = error / size; // a NaN gets through to the check
    }
  return worst;
}

constexpr double tolerance = 1.0e-10;

void check_rows(const Bed& bed, const Expected& expected, ContactEffects effects, bool wall) {
  CHECK(error_of(expected.force, bed.force.front().force, 8) < tolerance);
  if (effects.rotates()) CHECK(error_of(expected.turn, bed.force.front().turn, 8) < tolerance);
  if (effects.ledger() && effects.damped())
    CHECK(error_of(expected.damping, (wall ? bed.damping_wall : bed.damping_granule).front().force, 4) < tolerance);
  if (effects.ledger() && effects.rubs()) {
    const auto& rows = wall ? bed.friction_wall : bed.friction_granule;
    CHECK(error_of(expected.rubbing, rows.front().force, 8) < tolerance);
    if (effects.rotates()) CHECK(error_of(expected.turn, rows.front().turn, 8) < tolerance);
  }
}

void check_result(const ContactResult& result, const Expected& expected, ContactEffects effects) {
  CHECK(result.max_overlap == doctest::Approx(expected.max_overlap).epsilon(1.0e-12));
  CHECK(result.max_closing == doctest::Approx(expected.max_closing).epsilon(1.0e-10));
  if (!effects.energies()) return;
  CHECK(result.elastic == doctest::Approx(expected.elastic).epsilon(1.0e-10));
  CHECK(result.contacts == expected.contacts);
}

void add_contact(Expected& expected, const reference::Contact& contact, std::size_t i, double radius_i) {
  expected.force[i].add(1.0, contact.force_i);
  expected.turn[i].add(1.0 / radius_i, contact.torque_i);
  expected.damping[i].add(-contact.damping, contact.normal);
  expected.rubbing[i].add(1.0, contact.friction);
}

double cap(ContactEffects effects) {
  return reference::friction_cap * (effects.rotates() ? 2.0 / 7.0 : 1.0) / step;
}

void pad(std::vector<std::uint32_t>& list, std::uint32_t ghost) {
  while (list.size() % list_padding) list.push_back(ghost);
}

} // namespace

TEST_CASE("pair kernels: every instruction set and set of effects against the oracle") {
  for (const InstructionSet machine : machines())
    for (const ContactEffects effects : contact_effects())
      for (const std::size_t limit : {std::size_t{1}, std::size_t{13}, std::size_t{100000}}) {
        const std::string which = describe(machine, effects);
        CAPTURE(which);
        CAPTURE(limit);
        Bed bed = make_bed(effects, 7);
        const auto ghost = static_cast<std::uint32_t>(bed.count());
        std::vector<CandidatePair> pairs;
        for (std::uint32_t i = 0; i < ghost; ++i)
          for (std::uint32_t j = i + 1; j < ghost; ++j) pairs.push_back({i, j});
        std::shuffle(pairs.begin(), pairs.end(), std::mt19937_64(3));
        pairs.resize(std::min(pairs.size(), limit));

        Expected expected(bed.count());
        for (const CandidatePair& pair : pairs) {
          const auto& a = bed.granules[pair.first];
          const auto& b = bed.granules[pair.second];
          const auto contact = reference::pair_contact(a, b, bed.law(pair.first, pair.second, effects.variety), step);
          if (!contact.touching) continue;
          add_contact(expected, contact, pair.first, a.radius);
          expected.force[pair.second].add(-1.0, contact.force_i);
          expected.turn[pair.second].add(1.0 / b.radius, contact.torque_j);
          expected.damping[pair.second].add(contact.damping, contact.normal);
          expected.rubbing[pair.second].add(-1.0, contact.friction);
          expected.elastic += contact.elastic_energy;
          expected.max_overlap = std::max(expected.max_overlap, contact.overlap / std::min(a.radius, b.radius));
          expected.max_closing = std::max(expected.max_closing, contact.approach);
          ++expected.contacts;
        }
        if (limit == 100000) REQUIRE(expected.contacts > 40);

        while (pairs.size() % list_padding) pairs.push_back({ghost, ghost + 1});
        std::vector<CandidatePair> scratch(pair_chunk + list_padding);
        PairArguments arguments;
        arguments.granules = bed.arrays();
        arguments.pairs = pairs.data();
        arguments.count = pairs.size();
        arguments.touching = scratch.data();
        arguments.law = bed.rows.front();
        arguments.laws = bed.rows.data();
        arguments.populations = bed.populations;
        arguments.radius = bed.granules.front().radius;
        arguments.mass = bed.granules.front().mass;
        arguments.friction_cap = cap(effects);
        ContactResult result;
        pair_kernel_for(machine, effects)(arguments, result);
        check_rows(bed, expected, effects, false);
        check_result(result, expected, effects);
      }
}

TEST_CASE("pair kernels: lists longer than a chunk, and larger figures from before stay") {
  for (const InstructionSet machine : machines()) {
    const ContactEffects effects{kernels::Damping::tsuji, Friction::coulomb, Variety::alike, Observation::energies};
    Bed bed = make_bed(effects, 7);
    const auto ghost = static_cast<std::uint32_t>(bed.count());
    std::vector<CandidatePair> once;
    for (std::uint32_t i = 0; i < ghost; ++i)
      for (std::uint32_t j = i + 1; j < ghost; ++j) once.push_back({i, j});
    std::vector<CandidatePair> pairs;
    const int times = 10;
    for (int n = 0; n < times; ++n) pairs.insert(pairs.end(), once.begin(), once.end());
    while (pairs.size() % list_padding) pairs.push_back({ghost, ghost + 1});
    REQUIRE(pairs.size() > 2 * pair_chunk);
    std::int64_t contacts = 0;
    double elastic = 0.0;
    for (const CandidatePair& pair : once) {
      const auto contact =
          reference::pair_contact(bed.granules[pair.first], bed.granules[pair.second], bed.laws.front(), step);
      contacts += contact.touching;
      elastic += contact.elastic_energy;
    }
    std::vector<CandidatePair> scratch(pair_chunk + list_padding);
    PairArguments arguments;
    arguments.granules = bed.arrays();
    arguments.pairs = pairs.data();
    arguments.count = pairs.size();
    arguments.touching = scratch.data();
    arguments.law = bed.rows.front();
    arguments.radius = bed.granules.front().radius;
    arguments.mass = bed.granules.front().mass;
    arguments.friction_cap = cap(effects);
    ContactResult result;
    result.max_overlap = 0.9;
    result.max_closing = 77.0;
    pair_kernel_for(machine, effects)(arguments, result);
    CHECK(result.contacts == times * contacts);
    CHECK(result.elastic == doctest::Approx(times * elastic).epsilon(1.0e-10));
    CHECK(result.max_overlap == 0.9);
    CHECK(result.max_closing == 77.0);
  }
}

TEST_CASE("wall kernels: every instruction set, set of effects, plane and side against the oracle") {
  const double structure_mass = 3.0e-5;
  const reference::Vector direction{0.6, 0.0, 0.8};
  for (const InstructionSet machine : machines())
    for (const ContactEffects effects : contact_effects())
      for (int surface = 0; surface < 9; ++surface) // six faces, three sides
        for (const bool carried : {false, true}) {
          const std::string which = describe(machine, effects);
          CAPTURE(which);
          CAPTURE(surface);
          CAPTURE(carried);
          Bed bed = make_bed(effects, 17);
          const double radius = 1.5e-3, side = (3 * 1.96 + 1.96) * radius;
          const reference::Vector size{side, side, (2 * 1.96 + 1.96) * radius};
          // A cylinder around the middle of the bed, so narrow that its corners stick out; one granule on its axis.
          const int axis = surface - 6;
          const double diameter = 1.05 * side;
          const auto along = static_cast<std::size_t>(axis < 0 ? 0 : axis);
          if (axis >= 0)
            for (std::size_t i = 0; i < bed.count(); ++i)
              for (std::size_t k = 0; k < 3; ++k) {
                double& x = bed.granules[i].position[k];
                if (k != along) x = i == 5 ? 0.5 * diameter : x + 0.5 * (diameter - size[k]);
                (&bed.position[i].x)[k] = x;
              }

          const auto ghost = static_cast<std::uint32_t>(bed.count());
          std::vector<std::uint32_t> list;
          for (std::uint32_t i = 0; i < ghost; ++i)
            if (i % 7 != 3) list.push_back(i);
          Expected expected(bed.count());
          for (const std::uint32_t i : list) {
            const auto& g = bed.granules[i];
            reference::WallPoint wall;
            if (axis < 0) {
              wall = reference::box_walls(size, g.position)[static_cast<std::size_t>(surface)];
            } else {
              const auto walls = reference::cylinder_walls(diameter, 1.0, axis, g.position);
              if (walls.size() < 3) continue; // on the axis: no side
              wall = walls.front();
            }
            const double damping_mass =
                carried ? reference::wall_effective_mass(g.mass, wall.outward, direction, structure_mass) : g.mass;
            const double slip_mass = carried ? 1.0 / (1.0 / g.mass + 1.0 / structure_mass) : g.mass;
            const auto contact = reference::wall_contact(
                g, wall.distance, wall.outward, bed.wall_law(i, effects.variety), step, damping_mass, slip_mass);
            if (!contact.touching) continue;
            add_contact(expected, contact, i, g.radius);
            expected.total.add(1.0, contact.force_i);
            expected.elastic += contact.elastic_energy;
            expected.max_overlap = std::max(expected.max_overlap, contact.overlap / g.radius);
            expected.max_closing = std::max(expected.max_closing, contact.approach);
            ++expected.contacts;
          }
          REQUIRE(expected.contacts > 3);

          WallArguments arguments;
          arguments.granules = bed.arrays();
          arguments.count = list.size();
          pad(list, ghost);
          arguments.list = list.data();
          std::vector<std::uint32_t> scratch(list.size() + list_padding);
          arguments.touching = scratch.data();
          arguments.law = bed.rows.front();
          arguments.laws = bed.rows.data();
          arguments.friction_cap = cap(effects);
          for (std::size_t k = 0; k < 3; ++k) arguments.direction[k] = direction[k];
          if (carried) arguments.enclosure_inverse_mass = arguments.friction_inverse_mass = 1.0 / structure_mass;
          if (axis < 0) {
            const auto k = static_cast<std::size_t>(surface / 2);
            arguments.surface.normal[k] = surface % 2 ? 1.0 : -1.0;
            arguments.surface.offset = surface % 2 ? size[k] : 0.0;
          } else {
            for (std::size_t k = 0; k < 3; ++k) {
              arguments.surface.across[k] = k == along ? 0.0 : 1.0;
              arguments.surface.centre[k] = k == along ? 0.0 : 0.5 * diameter;
            }
            arguments.surface.radius = 0.5 * diameter;
          }
          WallResult result;
          (axis < 0 ? plane_kernel_for(machine, effects) : side_kernel_for(machine, effects))(arguments, result);
          check_rows(bed, expected, effects, true);
          check_result(result, expected, effects);
          for (std::size_t k = 0; k < 3; ++k)
            CHECK(std::abs(result.force[k] - expected.total.value[k]) < tolerance * expected.total.size);
        }
}

TEST_CASE("motion kernels: every instruction set and set of effects against the oracle") {
  for (const InstructionSet machine : machines())
    for (const auto integration : {Integration::leapfrog, Integration::verlet})
      for (const bool rotates : {true, false})
        for (const bool accelerated : {true, false})
          for (const auto observation :
               {Observation::none, Observation::energies, Observation::ledger, Observation::ledger_and_energies})
            for (const std::uint32_t last : {4U, 5U, 10U, 27U, 48U}) {
              const std::string which = std::string(name(machine)) +
                                        (integration == Integration::verlet ? ", verlet" : ", leapfrog") +
                                        (rotates ? ", rotates" : "") + (accelerated ? ", accelerated" : "") +
                                        ", observation " + std::to_string(static_cast<int>(observation));
              CAPTURE(which);
              CAPTURE(last);
              const ContactEffects spins{kernels::Damping::tsuji, Friction::coulomb, Variety::sizes, observation};
              Bed bed = make_bed(spins, 23);
              Random random{std::mt19937_64(5)};
              const std::uint32_t first = 3;
              std::vector<MotionRow> predicted = bed.motion;
              const auto fill = [&](auto& rows, double size, bool turns) {
                for (auto& row : rows)
                  for (int k = 0; k < 3; ++k) {
                    row.force[k] = random(-size, size);
                    if constexpr (requires { row.turn; })
                      if (turns) row.turn[k] = random(-size, size);
                  }
              };
              fill(bed.force, 3.0, rotates);
              fill(bed.damping_granule, 0.3, false);
              fill(bed.damping_wall, 0.4, false);
              fill(bed.friction_granule, 0.5, rotates);
              fill(bed.friction_wall, 0.6, rotates);

              const reference::Vector gravity = accelerated ? reference::Vector{1.0, -3.0, -9.81} : reference::Vector{};
              const reference::Vector frame_kick =
                  accelerated ? reference::Vector{0.01, 0.0, 0.02} : reference::Vector{};
              const reference::Vector frame{0.3, 0.0, -0.7};
              std::vector<reference::Granule> moved = bed.granules;
              MotionResult expected;
              for (std::uint32_t i = first; i < last; ++i) {
                reference::Granule& g = moved[i];
                const reference::Granule before = g;
                const auto of = [](const double* v) { return reference::Vector{v[0], v[1], v[2]}; };
                reference::Vector torque = of(bed.force[i].turn);
                for (double& component : torque) component *= g.radius;
                reference::move(g, of(bed.force[i].force), torque, gravity, frame_kick, step);
                reference::Granule mean = before;
                for (std::size_t k = 0; k < 3; ++k) {
                  mean.velocity[k] = 0.5 * (before.velocity[k] + g.velocity[k]);
                  mean.spin[k] = 0.5 * (before.spin[k] + g.spin[k]);
                  expected.mass_moment[k] += g.mass * before.position[k];
                  expected.normal_granule -= step * bed.damping_granule[i].force[k] * mean.velocity[k];
                  expected.normal_wall -= step * bed.damping_wall[i].force[k] * mean.velocity[k];
                  expected.friction_granule -= step * (bed.friction_granule[i].force[k] * mean.velocity[k] +
                                                       bed.friction_granule[i].turn[k] * g.radius * mean.spin[k]);
                  expected.friction_wall -= step * (bed.friction_wall[i].force[k] * mean.velocity[k] +
                                                    bed.friction_wall[i].turn[k] * g.radius * mean.spin[k]);
                }
                double square = 0.0;
                for (std::size_t k = 0; k < 3; ++k) square += g.velocity[k] * g.velocity[k];
                expected.max_speed_squared = std::max(expected.max_speed_squared, square);
                expected.sum_speed_squared += square;
                for (std::size_t k = 0; k < 3; ++k) mean.velocity[k] += frame[k];
                if (!rotates) mean.spin = {};
                expected.kinetic += reference::kinetic_energy(mean);
              }

              const Bed untouched = bed;
              const std::vector<MotionRow> untouched_prediction = predicted;
              MotionArguments arguments;
              arguments.granules = bed.arrays();
              if (integration == Integration::verlet) arguments.granules.predicted = predicted.data();
              arguments.first = first;
              arguments.last = last;
              arguments.time_step = step;
              for (std::size_t k = 0; k < 3; ++k) {
                arguments.kick[k] = gravity[k] * step - frame_kick[k];
                arguments.frame_velocity[k] = frame[k];
              }
              MotionResult result;
              const MotionEffects effects{integration, rotates, accelerated, observation};
              motion_kernel_for(machine, effects)(arguments, result);

              double position = 0.0, velocity = 0.0, prediction = 0.0, left = 0.0;
              for (std::uint32_t i = first; i < last; ++i) {
                const auto& before = bed.granules[i];
                for (std::size_t k = 0; k < 3; ++k) {
                  const double radius = before.radius;
                  position = std::max(position, std::abs((&bed.position[i].x)[k] - moved[i].position[k]));
                  velocity = std::max({velocity, std::abs(bed.motion[i].velocity[k] - moved[i].velocity[k]),
                                       std::abs(bed.motion[i].surface_spin[k] - radius * moved[i].spin[k])});
                  if (integration == Integration::verlet) {
                    const double v = 1.5 * moved[i].velocity[k] - 0.5 * before.velocity[k];
                    const double s = radius * (1.5 * moved[i].spin[k] - 0.5 * before.spin[k]);
                    prediction = std::max({prediction, std::abs(predicted[i].velocity[k] - v),
                                           std::abs(predicted[i].surface_spin[k] - s)});
                  }
                  left += std::abs(bed.force[i].force[k]) + std::abs(bed.force[i].turn[k]);
                  if (effects.ledger())
                    left += std::abs(bed.damping_granule[i].force[k]) + std::abs(bed.damping_wall[i].force[k]) +
                            std::abs(bed.friction_granule[i].force[k]) + std::abs(bed.friction_granule[i].turn[k]) +
                            std::abs(bed.friction_wall[i].force[k]) + std::abs(bed.friction_wall[i].turn[k]);
                }
                CHECK(bed.motion[i].inverse_mass == untouched.motion[i].inverse_mass);
                CHECK(bed.motion[i].inverse_radius == untouched.motion[i].inverse_radius);
                CHECK(bed.position[i].radius == untouched.position[i].radius);
              }
              CHECK(position < 1.0e-17);
              CHECK(velocity < 1.0e-14);
              CHECK(prediction < 1.0e-14);
              CHECK(left == 0.0);
              for (std::uint32_t i = 0; i < bed.count() + 2; ++i) {
                if (i >= first && i < last) continue;
                for (int k = 0; k < 3; ++k) {
                  CHECK((&bed.position[i].x)[k] == (&untouched.position[i].x)[k]);
                  CHECK(bed.motion[i].velocity[k] == untouched.motion[i].velocity[k]);
                  CHECK(bed.force[i].force[k] == untouched.force[i].force[k]);
                  CHECK(predicted[i].velocity[k] == untouched_prediction[i].velocity[k]);
                }
              }
              CHECK(result.max_speed_squared == doctest::Approx(expected.max_speed_squared).epsilon(1.0e-13));
              CHECK(result.sum_speed_squared == doctest::Approx(expected.sum_speed_squared).epsilon(1.0e-13));
              if (effects.energies()) {
                CHECK(result.kinetic == doctest::Approx(expected.kinetic).epsilon(1.0e-13));
                for (int k = 0; k < 3; ++k)
                  CHECK(result.mass_moment[k] == doctest::Approx(expected.mass_moment[k]).epsilon(1.0e-13));
              }
              if (effects.ledger()) {
                const double size = step * 3.0 * last * 2.0;
                CHECK(std::abs(result.normal_granule - expected.normal_granule) < 1.0e-13 * size);
                CHECK(std::abs(result.normal_wall - expected.normal_wall) < 1.0e-13 * size);
                CHECK(std::abs(result.friction_granule - expected.friction_granule) < 1.0e-13 * size);
                CHECK(std::abs(result.friction_wall - expected.friction_wall) < 1.0e-13 * size);
              }
            }
}

TEST_CASE("candidate kernels: every instruction set finds exactly the pairs within reach") {
  Random random{std::mt19937_64(77)};
  const std::uint32_t count = 203;
  // A vector load at the end of a range may look past it: what stands there must not matter.
  std::vector<double> x(count + 16, std::nan("")), y = x, z = x, radius = x;
  for (std::uint32_t i = 0; i < count; ++i) {
    x[i] = random(0.0, 0.01);
    y[i] = random(0.0, 0.01);
    z[i] = random(0.0, 0.01);
    radius[i] = random(0.5e-3, 2.0e-3);
  }
  const double skin = 0.2e-3, common = 1.2e-3;
  for (const InstructionSet machine : machines())
    for (const bool alike : {true, false})
      for (int trial = 0; trial < 50; ++trial) {
        CAPTURE(std::string(name(machine)));
        CAPTURE(alike);
        const auto pick = [&](std::uint32_t low, std::uint32_t high) {
          return low + static_cast<std::uint32_t>(random.engine() % (high - low + 1));
        };
        const IndexRange own{pick(0, 60), pick(60, 75)};
        const std::uint32_t own_end = pick(own.last, 80);
        std::vector<IndexRange> ranges;
        for (std::uint32_t from = own_end; from < count;) {
          const std::uint32_t first = pick(from, std::min(from + 30, count)),
                              last = pick(first, std::min(first + 25, count));
          ranges.push_back({first, last});
          from = last + 1;
        }
        std::multiset<std::pair<std::uint32_t, std::uint32_t>> expected, found;
        for (std::uint32_t i = own.first; i < own.last; ++i) {
          const auto test = [&](std::uint32_t j) {
            const double reach = alike ? 2.0 * common + skin : radius[i] + radius[j] + skin;
            if (std::hypot(x[i] - x[j], y[i] - y[j], z[i] - z[j]) < reach) expected.insert({i, j});
          };
          for (std::uint32_t j = i + 1; j < own_end; ++j) test(j);
          for (const IndexRange& range : ranges)
            for (std::uint32_t j = range.first; j < range.last; ++j) test(j);
        }
        CandidateArguments arguments;
        arguments.x = x.data();
        arguments.y = y.data();
        arguments.z = z.data();
        arguments.radius = alike ? nullptr : radius.data();
        arguments.reach = alike ? 2.0 * common + skin : skin;
        std::vector<CandidatePair> room(count * count + list_padding);
        const CandidatePair* end = candidate_kernel_for(machine, alike)(arguments, own, own_end, ranges.data(),
                                                                        static_cast<int>(ranges.size()), room.data());
        for (const CandidatePair* pair = room.data(); pair != end; ++pair) found.insert({pair->first, pair->second});
        CHECK(found == expected);
      }
}

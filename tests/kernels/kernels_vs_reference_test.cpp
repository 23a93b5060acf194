// The contact kernels of every instruction set that this machine runs, in every set of effects, against the scalar
// oracle on random contacts.
#include "tests/support/kernel_bed.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace grandamp;
using namespace grandamp::test;

namespace {

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
  std::vector<int> touching;
  double elastic = 0.0, spring = 0.0, max_overlap = 0.0, max_closing = 0.0;
  std::int64_t contacts = 0;
  Sum total; ///< on the granules

  explicit Expected(std::size_t count) : force(count), turn(count), damping(count), rubbing(count), touching(count) {}
};

/// Largest difference of the rows from what is expected, over its size. The overlap is a difference of lengths a
/// hundred times its size, so some digits are lost in it by any program.
template <class Number>
double error_of(const std::vector<Expected::Sum>& expected, const Number* rows, std::size_t stride) {
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

/// In float a force is rounded some ten times on its way, each time by up to 6e-8 of what goes into it.
constexpr double float_tolerance = 10.0 * 1.2e-7;
double tolerance_of(ContactEffects effects) {
  return effects.precision == Precision::mixed ? float_tolerance : 1.0e-10;
}
constexpr double tolerance = 1.0e-10;

/// The granules that touch a wall are marked, and no others have walls' rows.
void check_marks(const Bed& bed, const Expected& expected, ContactEffects effects, bool wall) {
  if (!effects.ledger() || (!effects.damped() && !effects.rubs())) return;
  for (std::size_t i = 0; i < expected.touching.size(); ++i) {
    const bool touches = wall && expected.touching[i] > 0;
    CHECK((bed.touches_wall[i] != 0) == touches);
    for (std::size_t k = 0; k < 3 && !touches; ++k) {
      CHECK(bed.damping_wall[i].force[k] == 0.0);
      CHECK(bed.friction_wall[i].force[k] == 0.0);
      CHECK(bed.friction_wall[i].turn[k] == 0.0);
    }
  }
}

void check_rows(const Bed& bed, const Expected& expected, ContactEffects effects, bool wall) {
  check_marks(bed, expected, effects, wall);
  const double within = tolerance_of(effects);
  for (std::size_t i = 0; i < expected.touching.size() && effects.counts(); ++i) {
    CHECK(bed.force[i].touching == expected.touching[i]);
    CHECK(bed.force[i].friction_share == 1.0 / (1.0 + std::max(bed.granules[i].touching, 1)));
  }
  CHECK(error_of(expected.force, bed.force.front().force, 8) < within);
  if (effects.rotates()) CHECK(error_of(expected.turn, bed.force.front().turn, 8) < within);
  if (!effects.ledger()) return;
  if (!wall) {
    if (effects.damped()) CHECK(error_of(expected.damping, bed.loss.front().damping, 8) < float_tolerance);
    if (effects.rubs()) CHECK(error_of(expected.rubbing, bed.loss.front().friction, 8) < float_tolerance);
    return;
  }
  if (effects.damped()) CHECK(error_of(expected.damping, bed.damping_wall.front().force, 4) < within);
  if (effects.rubs()) CHECK(error_of(expected.rubbing, bed.friction_wall.front().force, 8) < within);
  if (effects.rubs() && effects.rotates()) CHECK(error_of(expected.turn, bed.friction_wall.front().turn, 8) < within);
}

/// The deepest contact is looked for only where one could be deeper than the deepest so far: it is found if that is
/// less by a hair, and not if it is more.
void check_records(const PairArguments& arguments, PairKernel* kernel, const Expected& expected,
                   ContactEffects effects) {
  if (effects.remembers() || expected.max_overlap == 0.0) return;
  const double hair = effects.precision == Precision::mixed ? 1.0e-4 : 1.0e-9;
  const double within = effects.precision == Precision::mixed ? 1.0e-5 : 1.0e-12;
  ContactResult below, above;
  below.max_overlap = (1.0 - hair) * expected.max_overlap;
  above.max_overlap = (1.0 + hair) * expected.max_overlap;
  const double before = above.max_overlap;
  kernel(arguments, below);
  kernel(arguments, above);
  CHECK(below.max_overlap == doctest::Approx(expected.max_overlap).epsilon(within));
  CHECK(above.max_overlap == doctest::Approx(before).epsilon(within));
}

void check_result(const ContactResult& result, const Expected& expected, ContactEffects effects) {
  const double within = tolerance_of(effects);
  CHECK(result.max_overlap ==
        doctest::Approx(expected.max_overlap).epsilon(effects.precision == Precision::mixed ? within : 1.0e-12));
  CHECK(result.max_closing == doctest::Approx(expected.max_closing).epsilon(within));
  if (!effects.energies()) return;
  CHECK(result.elastic == doctest::Approx(expected.elastic).epsilon(within));
  CHECK(result.spring == doctest::Approx(expected.spring).epsilon(1.0e-10));
  CHECK(result.contacts == expected.contacts);
}

/// The memory of one entry of the list after the step.
void check_memory(const Springs& springs, std::size_t entry, const reference::Contact& contact, double reduced_radius) {
  CHECK(springs.touched[entry] == Springs::now);
  const SpringRow& row = springs.rows[entry];
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(std::abs(row.force[k] - contact.memory.force[k]) < tolerance * (contact.spring + 1.0));
  CHECK(row.root == doctest::Approx(std::sqrt(reduced_radius * contact.overlap)).epsilon(1.0e-10));
}

/// Friction is a coefficient times the slip, which may be the small rest of large velocities: the size of those.
double size_of_friction(const reference::Contact& contact, const reference::Granule& a, const reference::Granule& b) {
  const auto length = [](const reference::Vector& v) { return std::hypot(v[0], v[1], v[2]); };
  const double slip = length(contact.slip);
  if (slip == 0.0) return 0.0;
  return length(contact.friction) / slip *
         (length(a.velocity) + length(b.velocity) + a.radius * length(a.spin) + b.radius * length(b.spin));
}

void add_contact(Expected& expected, const reference::Contact& contact, std::size_t i, double radius_i,
                 double friction_size = 0.0) {
  ++expected.touching[i];
  expected.force[i].add(1.0, contact.force_i);
  expected.turn[i].add(1.0 / radius_i, contact.torque_i);
  expected.damping[i].add(-contact.damping, contact.normal);
  expected.rubbing[i].add(1.0, contact.friction);
  for (auto* sums : {&expected.force, &expected.turn, &expected.rubbing}) (*sums)[i].size += friction_size;
  expected.elastic += contact.elastic_energy;
  expected.spring += contact.spring_energy;
}

double cap(ContactEffects effects) {
  return (effects.rotates() ? 2.0 / 7.0 : 1.0) / step;
}

void pad(std::vector<std::uint32_t>& list, std::uint32_t ghost) {
  while (list.size() % list_padding) list.push_back(ghost);
}

} // namespace

namespace {

bool touch(const Bed& bed, const RowPair& pair) {
  const auto &a = bed.granules[pair.first()], &b = bed.granules[pair.second()];
  return reference::pair_contact(a, b, bed.laws.front(), step).touching;
}

/// Everything that a pair kernel may ask for, but springs. `pairs` are padded.
PairArguments arguments_for(Bed& bed, ContactEffects effects, const std::vector<RowPair>& pairs,
                            std::vector<RowPair>& scratch) {
  scratch.resize(contact_scratch);
  PairArguments a;
  a.granules = bed.arrays();
  a.pairs = pairs.data();
  a.count = pairs.size();
  a.touching = scratch.data();
  a.law = bed.rows.front();
  a.laws = bed.rows.data();
  a.populations = bed.populations;
  a.radius = bed.largest_radius();
  a.mass = bed.granules.front().mass;
  a.friction_cap = cap(effects);
  return a;
}

void check_pairs(const std::vector<ContactEffects>& sets) {
  for (const InstructionSet machine : machines())
    for (const ContactEffects effects : sets)
      // A pair, a few, those that touch first so that they stand close, and all, among which few touch.
      for (const std::size_t limit : {std::size_t{1}, std::size_t{13}, std::size_t{150}, std::size_t{100000}}) {
        const std::string which = describe(machine, effects);
        CAPTURE(which);
        CAPTURE(limit);
        Bed bed = make_bed(effects, 7);
        const auto ghost = static_cast<std::uint32_t>(bed.count());
        std::vector<RowPair> pairs;
        for (std::uint32_t i = 0; i < ghost; ++i)
          for (std::uint32_t j = i + 1; j < ghost; ++j) pairs.push_back(RowPair::of(i, j));
        std::shuffle(pairs.begin(), pairs.end(), std::mt19937_64(3));
        if (limit == 150) {
          const auto apart =
              std::stable_partition(pairs.begin(), pairs.end(), [&](const RowPair& pair) { return touch(bed, pair); });
          REQUIRE(apart - pairs.begin() > 32); // of the first 64
          REQUIRE(apart - pairs.begin() < 150);
        }
        pairs.resize(std::min(pairs.size(), limit));

        Expected expected(bed.count());
        Springs springs(pairs.size() + list_padding);
        Random random{std::mt19937_64(31)};
        const bool otherwise = effects.remembers() && limit != 13;
        if (otherwise) arrive_otherwise(bed, 5);
        std::vector<reference::Contact> contacts;
        for (std::size_t entry = 0; entry < pairs.size(); ++entry) {
          const RowPair& pair = pairs[entry];
          const auto& a = bed.granules[pair.first()];
          const auto& b = bed.granules[pair.second()];
          const auto& law = bed.law(pair.first(), pair.second(), effects.variety);
          const double reduced = a.radius * b.radius / (a.radius + b.radius);
          springs.load(entry, 3.0e-5, reduced, random);
          const reference::Arrival arrival =
              otherwise ? arrival_of(bed, pair.first(), pair.second()) : reference::Arrival{};
          const auto contact =
              reference::pair_contact(a, b, law, step, springs.before[entry], otherwise ? &arrival : nullptr);
          contacts.push_back(contact);
          if (!contact.touching) continue;
          const double friction_size = effects.precision == Precision::mixed ? size_of_friction(contact, a, b) : 0.0;
          add_contact(expected, contact, pair.first(), a.radius, friction_size);
          for (auto* sums : {&expected.force, &expected.turn, &expected.rubbing})
            (*sums)[pair.second()].size += friction_size;
          ++expected.touching[pair.second()];
          expected.force[pair.second()].add(-1.0, contact.force_i);
          expected.turn[pair.second()].add(1.0 / b.radius, contact.torque_j);
          expected.damping[pair.second()].add(contact.damping, contact.normal);
          expected.rubbing[pair.second()].add(-1.0, contact.friction);
          expected.max_overlap = std::max(expected.max_overlap, contact.overlap / std::min(a.radius, b.radius));
          expected.max_closing = std::max(expected.max_closing, contact.approach);
          ++expected.contacts;
        }
        if (limit == 100000) {
          REQUIRE(expected.contacts > 40);
          REQUIRE(pairs.size() > contact_chunk);
        }

        while (pairs.size() % list_padding) pairs.push_back(RowPair::of(ghost, ghost + 1));
        std::vector<RowPair> scratch;
        PairArguments arguments = arguments_for(bed, effects, pairs, scratch);
        if (effects.remembers()) arguments.springs = springs.arguments(bed);
        if (limit != 1) arguments.ahead = {{{3, ghost / 2}, {ghost / 2 + 1, ghost}}}; // changes nothing
        const std::vector<std::uint32_t> touched_before = springs.touched;
        ContactResult result;
        pair_kernel_for(machine, effects)(arguments, result);
        check_rows(bed, expected, effects, false);
        check_result(result, expected, effects);
        check_records(arguments, pair_kernel_for(machine, effects), expected, effects);
        for (std::size_t entry = 0; entry < contacts.size() && effects.remembers(); ++entry) {
          const auto& a = bed.granules[pairs[entry].first()];
          const auto& b = bed.granules[pairs[entry].second()];
          if (contacts[entry].touching)
            check_memory(springs, entry, contacts[entry], a.radius * b.radius / (a.radius + b.radius));
          else
            CHECK(springs.touched[entry] == touched_before[entry]);
        }
      }
}

} // namespace

TEST_CASE("pair kernels: every instruction set and set of effects against the oracle") {
  check_pairs(contact_effects());
}

TEST_CASE("pair kernels of mixed precision against the oracle, within what float can hold") {
  check_pairs(mixed_effects());
}

TEST_CASE("mixed precision keeps overlaps that float coordinates could not tell") {
  for (const InstructionSet machine : machines())
    for (const auto variety : {Variety::alike, Variety::sizes}) {
      ContactEffects effects{kernels::Damping::none, Friction::none, variety, Observation::none, Precision::mixed};
      double worst = 0.0;
      for (double share = 1.0e-8; share < 0.05; share *= 1.7) {
        Bed bed = make_bed(effects, 7);
        const double radius = bed.granules[0].radius, other = bed.granules[1].radius;
        const double apart = (radius + other) - share * std::min(radius, other);
        bed.granules[0].position = {0.13, 0.07, 0.21}; // far from the origin, as in a wide box
        bed.granules[1].position = {0.13 + apart * 2.0 / 3.0, 0.07 - apart / 3.0, 0.21 + apart * 2.0 / 3.0};
        for (std::size_t i = 0; i < 2; ++i)
          for (std::size_t k = 0; k < 3; ++k) (&bed.position[i].x)[k] = bed.granules[i].position[k];
        const auto contact = reference::pair_contact(bed.granules[0], bed.granules[1], bed.laws.front(), step);
        REQUIRE(contact.touching);
        const auto ghost = static_cast<std::uint32_t>(bed.count());
        std::vector<RowPair> pairs(list_padding, RowPair::of(ghost, ghost + 1));
        std::vector<RowPair> scratch;
        pairs[3] = RowPair::of(0, 1);
        PairArguments arguments = arguments_for(bed, effects, pairs, scratch);
        ContactResult result;
        pair_kernel_for(machine, effects)(arguments, result);
        double error = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
          error = std::max(error, std::abs(bed.force[0].force[k] - contact.force_i[k]));
          CHECK(bed.force[1].force[k] == -bed.force[0].force[k]);
        }
        // Places 0.2 m from the origin are told to 3e-17 m: that much of an overlap is lost by any program.
        worst = std::max(worst, (error / contact.spring) / (1.0 + 1.0e-10 / share));
      }
      CAPTURE(name(machine));
      CHECK(worst < 2.0e-6);
    }
}

TEST_CASE("pair kernels: granules that only just touch are pushed apart or not at all") {
  for (const InstructionSet machine : machines())
    for (const auto variety : {Variety::alike, Variety::sizes})
      for (const auto precision : {Precision::full, Precision::mixed})
        for (const auto friction : {Friction::none, Friction::coulomb}) {
          const auto damping = friction == Friction::none ? kernels::Damping::none : kernels::Damping::tsuji;
          const ContactEffects effects{damping, friction, variety, Observation::energies, precision};
          const std::string which = describe(machine, effects);
          CAPTURE(which);
          Random random{std::mt19937_64(11)};
          std::int64_t touching = 0, pushed = 0;
          const int tries = 2000;
          bool right = true;
          for (int n = 0; n < tries; ++n) {
            Bed bed = make_bed(effects, 7);
            const double sum = bed.granules[0].radius + bed.granules[1].radius;
            reference::Vector along = random.vector(1.0);
            const double length = std::hypot(along[0], along[1], along[2]);
            const double apart = sum * (1.0 + random(-4.0, 4.0) * std::numeric_limits<double>::epsilon());
            for (std::size_t k = 0; k < 3; ++k) {
              (&bed.position[0].x)[k] = 0.0;
              (&bed.position[1].x)[k] = along[k] * (apart / length);
            }
            const auto ghost = static_cast<std::uint32_t>(bed.count());
            std::vector<RowPair> pairs(list_padding, RowPair::of(ghost, ghost + 1));
            std::vector<RowPair> scratch;
            pairs[5] = RowPair::of(0, 1);
            PairArguments arguments = arguments_for(bed, effects, pairs, scratch);
            ContactResult result;
            pair_kernel_for(machine, effects)(arguments, result);
            touching += result.contacts;
            right = right && result.max_overlap >= 0.0 && result.max_overlap < 1.0e-14 && result.elastic >= 0.0;
            double push = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
              push -= bed.force[0].force[k] * along[k];
              right = right && std::isfinite(bed.force[0].force[k]) && std::isfinite(bed.force[0].turn[k]);
            }
            if (friction == Friction::none) right = right && push >= 0.0;
            pushed += push > 0.0;
          }
          CHECK(right);
          // Some of them touch, some of these by less than can be told.
          CHECK(touching > tries / 10);
          CHECK(touching < tries - tries / 10);
          if (friction == Friction::none) CHECK(pushed > 0);
        }
}

TEST_CASE("what a set of effects leaves out is not even read by its pair kernels") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<ContactEffects> sets = contact_effects();
  sets.push_back({kernels::Damping::tsuji, Friction::none, Variety::alike, Observation::none, Precision::mixed});
  sets.push_back({kernels::Damping::tsuji, Friction::coulomb, Variety::alike, Observation::none, Precision::mixed});
  for (const InstructionSet machine : machines())
    for (const ContactEffects effects : sets) {
      // Rare laws are served by the kernels of several materials.
      if (effects.variety != Variety::alike || effects.ledger() || effects.remembers() || effects.only_pushes())
        continue;
      const std::string which = describe(machine, effects);
      CAPTURE(which);
      Bed bed = make_bed(effects, 7);
      const auto ghost = static_cast<std::uint32_t>(bed.count());
      std::vector<RowPair> pairs;
      std::vector<RowPair> scratch;
      for (std::uint32_t i = 0; i < ghost; ++i)
        for (std::uint32_t j = i + 1; j < ghost; ++j) pairs.push_back(RowPair::of(i, j));
      while (pairs.size() % list_padding) pairs.push_back(RowPair::of(ghost, ghost + 1));
      if (!effects.rotates())
        for (std::size_t i = 0; i < bed.motion.size(); ++i)
          for (int k = 0; k < 3; ++k) bed.motion[i].surface_spin[k] = bed.force[i].turn[k] = nan;
      PairArguments arguments = arguments_for(bed, effects, pairs, scratch);
      arguments.granules.loss = nullptr;
      if (!effects.rubs()) arguments.law.friction = nan;
      if (!effects.damped()) arguments.law.damping = nan;
      if (!effects.rubs()) arguments.friction_cap = nan;
      if (!effects.damped() && !effects.rubs()) arguments.mass = nan;
      arguments.granules.population = nullptr;
      arguments.laws = nullptr;
      ContactResult result;
      pair_kernel_for(machine, effects)(arguments, result);
      bool finite = std::isfinite(result.max_overlap) && std::isfinite(result.max_closing);
      for (std::size_t i = 0; i < bed.count(); ++i)
        for (int k = 0; k < 3; ++k) {
          finite = finite && std::isfinite(bed.force[i].force[k]);
          if (!effects.rotates()) CHECK(std::isnan(bed.force[i].turn[k]));
        }
      CHECK(finite);
    }
}

TEST_CASE("pair kernels: lists longer than a chunk, and larger figures from before stay") {
  for (const InstructionSet machine : machines()) {
    const ContactEffects effects{kernels::Damping::tsuji, Friction::coulomb, Variety::alike, Observation::energies};
    Bed bed = make_bed(effects, 7);
    const auto ghost = static_cast<std::uint32_t>(bed.count());
    std::vector<RowPair> once;
    for (std::uint32_t i = 0; i < ghost; ++i)
      for (std::uint32_t j = i + 1; j < ghost; ++j) once.push_back(RowPair::of(i, j));
    std::vector<RowPair> pairs;
    const int times = 10;
    for (int n = 0; n < times; ++n) pairs.insert(pairs.end(), once.begin(), once.end());
    while (pairs.size() % list_padding) pairs.push_back(RowPair::of(ghost, ghost + 1));
    REQUIRE(pairs.size() > 2 * contact_chunk);
    std::int64_t contacts = 0;
    double elastic = 0.0;
    for (const RowPair& pair : once) {
      const auto contact =
          reference::pair_contact(bed.granules[pair.first()], bed.granules[pair.second()], bed.laws.front(), step);
      contacts += contact.touching;
      elastic += contact.elastic_energy;
    }
    std::vector<RowPair> scratch;
    PairArguments arguments = arguments_for(bed, effects, pairs, scratch);
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
          // Once more than fits a chunk of the list.
          const std::size_t least = (surface == 1 || surface == 6) && carried ? contact_chunk + 1 : 1;
          while (list.size() < least)
            for (std::uint32_t i = 0; i < ghost; ++i)
              if (i % 7 != 3) list.push_back(i);
          Expected expected(bed.count());
          Springs springs(list.size() + list_padding);
          Random random{std::mt19937_64(41)};
          const bool otherwise = effects.remembers() && surface % 2 == 1;
          if (otherwise) arrive_otherwise(bed, 6);
          std::vector<reference::Contact> contacts(list.size());
          for (std::size_t entry = 0; entry < list.size(); ++entry) {
            const std::uint32_t i = list[entry];
            const auto& g = bed.granules[i];
            springs.load(entry, 3.0e-5, g.radius, random);
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
            const reference::Arrival arrival = otherwise ? arrival_of(bed, i, i) : reference::Arrival{};
            const auto& contact = contacts[entry] =
                reference::wall_contact(g, wall.distance, wall.outward, bed.wall_law(i, effects.variety), step,
                                        damping_mass, slip_mass, springs.before[entry], otherwise ? &arrival : nullptr);
            if (!contact.touching) continue;
            add_contact(expected, contact, i, g.radius);
            expected.total.add(1.0, contact.force_i);
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
          std::vector<std::uint32_t> scratch(contact_scratch);
          arguments.touching = scratch.data();
          arguments.law = bed.rows.front();
          arguments.laws = bed.rows.data();
          arguments.friction_cap = cap(effects);
          if (effects.remembers()) arguments.springs = springs.arguments(bed);
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
          for (std::size_t entry = 0; entry < contacts.size() && effects.remembers(); ++entry)
            if (contacts[entry].touching)
              check_memory(springs, entry, contacts[entry], bed.granules[list[entry]].radius);
          for (std::size_t k = 0; k < 3; ++k)
            CHECK(std::abs(result.force[k] - expected.total.value[k]) < tolerance * expected.total.size);
        }
}

// Google Benchmark for each kernel, through the dispatch that a run uses, for each instruction set that this machine
// has. Every benchmark reports "ns_per_item": per candidate tested, per contact, per granule moved or listed.
#include "kernels/dispatch.hpp"
#include "solver/verlet_list.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

namespace {

using namespace grandamp;
using kernels::ContactEffects;
using kernels::Damping;
using kernels::Friction;
using kernels::InstructionSet;
using kernels::Observation;
using kernels::Precision;
using kernels::Variety;

constexpr double radius = 1.0e-3;    // m
constexpr double mass = 4.98e-6;     // kg
constexpr double time_step = 4.5e-6; // s

/// A cubic lattice with jitter: `pitch` below two radii and all neighbours touch, above and none does.
struct Bed {
  Bed(int across, double pitch, double jitter, bool ledger)
      : side(across),
        granules(static_cast<std::size_t>(across) * static_cast<std::size_t>(across) * static_cast<std::size_t>(across),
                 {.predicted = false, .ledger = ledger, .shares = true}) {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    size.fill(pitch * across);
    for (std::uint32_t i = 0; i < granules.count(); ++i) {
      const auto n = static_cast<std::uint32_t>(across);
      const std::array<std::uint32_t, 3> at{i % n, i / n % n, i / n / n};
      double* const p = &granules.position[i].x;
      for (std::size_t k = 0; k < 3; ++k) p[k] = (at[k] + 0.5) * pitch + jitter * any(engine);
      granules.position[i].radius = radius;
      kernels::MotionRow& m = granules.motion[i];
      for (std::size_t k = 0; k < 3; ++k) {
        m.velocity[k] = 0.3 * any(engine);
        m.surface_spin[k] = 0.3 * any(engine);
      }
      m.inverse_mass = 1.0 / mass;
      m.inverse_radius = 1.0 / radius;
      granules.id[i] = i;
      granules.population[i] = static_cast<std::uint8_t>(i % 2);
    }
    granules.set_ghosts();
    for (std::uint32_t g = granules.count(); g < granules.count() + 2; ++g) granules.population[g] = 0;
  }

  /// Pairs closer than `reach` between centres, in sorted order, padded.
  std::vector<kernels::RowPair> pairs(double reach) const {
    std::vector<kernels::RowPair> list;
    const int n = side;
    for (std::uint32_t i = 0; i < granules.count(); ++i)
      for (int dz = 0; dz <= 1; ++dz)
        for (int dy = dz > 0 ? -1 : 0; dy <= 1; ++dy)
          for (int dx = dz > 0 || dy > 0 ? -1 : 1; dx <= 1; ++dx) {
            const int x = static_cast<int>(i) % n + dx, y = static_cast<int>(i) / n % n + dy,
                      z = static_cast<int>(i) / n / n + dz;
            if (x < 0 || x >= n || y < 0 || y >= n || z >= n) continue;
            const auto j = static_cast<std::uint32_t>((z * n + y) * n + x);
            const auto &a = granules.position[i], &b = granules.position[j];
            if (std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) < reach) list.push_back(kernels::RowPair::of(i, j));
          }
    while (list.size() % kernels::list_padding != 0)
      list.push_back(kernels::RowPair::of(granules.count(), granules.count() + 1));
    return list;
  }

  int side;
  Vector3 size{};
  Granules granules;
};

constexpr kernels::LawRow law{2.58e8, 0.0829, 0.52, 0.0};
const std::vector<kernels::LawRow> laws{law, {2.5e8, 0.08, 0.5, 0.0}, {2.5e8, 0.08, 0.5, 0.0}, {2.4e8, 0.07, 0.4, 0.0}};

void report(benchmark::State& state, double items) {
  state.counters["ns_per_item"] =
      benchmark::Counter(1e-9 * items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

constexpr int bed_side = 13; // 2,197 granules: S1's number

void pair_bench(benchmark::State& state, InstructionSet set, ContactEffects effects, bool touching) {
  Bed bed(bed_side, (touching ? 1.97 : 2.1) * radius, (touching ? 0.005 : 0.03) * radius, effects.ledger());
  const std::vector<kernels::RowPair> list = bed.pairs((touching ? 2.0 : 2.3) * radius);
  std::vector<kernels::RowPair> scratch(kernels::contact_scratch);
  kernels::PairArguments a;
  a.granules = bed.granules.arrays();
  a.pairs = list.data();
  a.count = list.size();
  a.touching = scratch.data();
  a.law = law;
  a.laws = laws.data();
  a.populations = 2;
  a.radius = radius;
  a.mass = mass;
  a.friction_cap = (effects.rotates() ? 2.0 / 7.0 : 1.0) / time_step;
  kernels::PairKernel* const kernel = kernels::pair_kernel_for(set, effects);
  kernels::ContactResult result;
  for (auto _ : state) {
    kernel(a, result);
    benchmark::DoNotOptimize(result);
  }
  report(state, static_cast<double>(list.size()));
}

void wall_bench(benchmark::State& state, InstructionSet set, ContactEffects effects, bool side, bool touching) {
  Bed bed(bed_side, 2.1 * radius, 0.0, false);
  std::vector<std::uint32_t> list(bed.granules.count()), scratch(kernels::contact_scratch);
  const double distance = (touching ? 0.99 : 1.05) * radius;
  kernels::WallArguments a;
  if (side) {
    a.surface.across[2] = 0.0;
    a.surface.across[0] = a.surface.across[1] = 1.0;
    a.surface.radius = 20.0 * radius;
  } else {
    a.surface.normal[2] = -1.0;
  }
  for (std::uint32_t i = 0; i < bed.granules.count(); ++i) {
    list[i] = i;
    kernels::PositionRow& row = bed.granules.position[i];
    if (side) {
      const double away = 20.0 * radius - distance, angle = 0.1 * i;
      row = {away * std::cos(angle), away * std::sin(angle), row.z, radius};
    } else {
      row.z = distance;
    }
  }
  while (list.size() % kernels::list_padding != 0) list.push_back(bed.granules.count());
  a.granules = bed.granules.arrays();
  a.list = list.data();
  a.count = bed.granules.count();
  a.touching = scratch.data();
  a.law = law;
  a.laws = laws.data();
  a.direction[0] = 1.0;
  a.enclosure_inverse_mass = a.friction_inverse_mass = 1.0;
  a.friction_cap = 2.0 / 7.0 / time_step;
  kernels::WallKernel* const kernel =
      side ? kernels::side_kernel_for(set, effects) : kernels::plane_kernel_for(set, effects);
  kernels::WallResult result;
  for (auto _ : state) {
    kernel(a, result);
    benchmark::DoNotOptimize(result);
  }
  report(state, bed.granules.count());
}

void motion_bench(benchmark::State& state, InstructionSet set, kernels::MotionEffects effects, int across) {
  Bed bed(across, 2.1 * radius, 0.0, effects.ledger());
  kernels::MotionArguments a;
  a.granules = bed.granules.arrays();
  a.last = bed.granules.count();
  a.time_step = 1.0e-12; // nobody gets anywhere
  kernels::MotionKernel* const kernel = kernels::motion_kernel_for(set, effects);
  kernels::MotionResult result;
  for (auto _ : state) {
    kernel(a, result);
    benchmark::DoNotOptimize(result);
  }
  report(state, a.last);
}

/// Sort, half-shell search, wall lists and cleared forces, of a bed of solid fraction 0.45 whose granules have moved by
/// up to a tenth of a radius since the last time.
void build_bench(benchmark::State& state, InstructionSet set, bool alike, int across) {
  Bed bed(across, 2.1 * radius, 0.0, false);
  std::vector<kernels::PositionRow> home(bed.granules.count());
  for (std::uint32_t i = 0; i < bed.granules.count(); ++i) home[i] = bed.granules.position[i];
  const std::vector<Wall> walls = make_walls({.shape = EnclosureShape::box, .size = bed.size});
  VerletList list;
  VerletList::Search search = VerletList::Search::with(set, alike, radius);
  search.skin = 0.4 * radius;
  search.cell_length = 2.4 * radius;
  const Team team(1);
  std::minstd_rand engine(7);
  std::uniform_real_distribution<double> jitter(-0.1 * radius, 0.1 * radius);
  list.build(bed.granules, bed.size, walls, search, team);
  for (auto _ : state) {
    state.PauseTiming();
    for (std::uint32_t row = 0; row < bed.granules.count(); ++row) {
      kernels::PositionRow& p = bed.granules.position[row];
      const kernels::PositionRow& h = home[bed.granules.id[row]];
      p = {h.x + jitter(engine), h.y + jitter(engine), h.z + jitter(engine), h.radius};
    }
    state.ResumeTiming();
    list.build(bed.granules, bed.size, walls, search, team);
  }
  report(state, bed.granules.count());
  state.counters["candidates_per_granule"] = static_cast<double>(list.candidates()) / bed.granules.count();
}

void register_pairs(InstructionSet set) {
  struct Variant {
    const char* name;
    ContactEffects effects;
  };
  const Variant variants[] = {
      {"frictionless", {Damping::tsuji, Friction::none, Variety::alike, Observation::none}},
      {"friction_without_rotation",
       {Damping::tsuji, Friction::coulomb_without_rotation, Variety::alike, Observation::none}},
      {"full_one_radius", {Damping::tsuji, Friction::coulomb, Variety::alike, Observation::none}},
      {"full_several_radii", {Damping::tsuji, Friction::coulomb, Variety::sizes, Observation::none}},
      {"full_several_materials", {Damping::tsuji, Friction::coulomb, Variety::materials, Observation::none}},
      {"full_several_radii_ledger", {Damping::tsuji, Friction::coulomb, Variety::sizes, Observation::ledger}},
      {"frictionless_mixed", {Damping::tsuji, Friction::none, Variety::alike, Observation::none, Precision::mixed}},
      {"full_one_radius_mixed",
       {Damping::tsuji, Friction::coulomb, Variety::alike, Observation::none, Precision::mixed}},
      {"full_several_radii_mixed",
       {Damping::tsuji, Friction::coulomb, Variety::sizes, Observation::none, Precision::mixed}},
      {"full_several_radii_ledger_mixed",
       {Damping::tsuji, Friction::coulomb, Variety::sizes, Observation::ledger, Precision::mixed}}};
  for (const Variant& v : variants) {
    for (const bool touching : {false, true})
      benchmark::RegisterBenchmark(
          fmt::format("{}/pair_{}/{}", kernels::name(set), touching ? "contact" : "candidate", v.name).c_str(),
          [=](benchmark::State& state) { pair_bench(state, set, v.effects, touching); });
    if (v.effects.variety != Variety::alike || v.effects.friction != Friction::coulomb ||
        v.effects.precision != Precision::full)
      continue;
    for (const bool side : {false, true})
      for (const bool touching : {false, true})
        benchmark::RegisterBenchmark(
            fmt::format("{}/wall_{}/{}", kernels::name(set), touching ? "contact" : "candidate",
                        side ? "cylinder" : "plane")
                .c_str(),
            [=](benchmark::State& state) { wall_bench(state, set, v.effects, side, touching); });
  }
}

void register_others(InstructionSet set) {
  const auto motion = [&](const char* name, kernels::MotionEffects effects, int across) {
    benchmark::RegisterBenchmark(fmt::format("{}/motion/{}", kernels::name(set), name).c_str(),
                                 [=](benchmark::State& state) { motion_bench(state, set, effects, across); });
  };
  kernels::MotionEffects effects;
  motion("2k", effects, bed_side);
  motion("1M", effects, 100);
  effects.observation = Observation::ledger;
  motion("2k_ledger", effects, bed_side);
  effects.observation = Observation::none;
  effects.rubbing = kernels::Rubbing::none;
  motion("2k_without_rotation", effects, bed_side);
  for (const bool alike : {true, false})
    for (const auto& [name, across] : {std::pair{"2k", 13}, std::pair{"100k", 46}, std::pair{"1M", 100}})
      benchmark::RegisterBenchmark(
          fmt::format("{}/build/{}_{}", kernels::name(set), name, alike ? "one_radius" : "several_radii").c_str(),
          [=, n = across](benchmark::State& state) { build_bench(state, set, alike, n); });
}

} // namespace

void register_limits();

int main(int argc, char** argv) {
  for (const InstructionSet set : {InstructionSet::generic, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!kernels::available(set)) continue;
    register_pairs(set);
    register_others(set);
  }
  register_limits();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}

// The same scene gives the same bits, however many threads share the work and whichever of the fused instruction sets
// does it.
#include "kernels/dispatch.hpp"
#include "solver/run_state.hpp"
#include "solver/simulation.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <numbers>
#include <string>

namespace grandamp::test {

namespace {

Population balls(std::size_t count, double radius) {
  Population population;
  population.name = "balls of " + std::to_string(radius);
  population.count = count;
  population.radius = radius;
  population.mass = 1190.0 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  population.speed = 1.0;
  return population;
}

/// A cloud flying about in a box that a structure carries.
Scene cloud(std::size_t count, const Vector3& size) {
  Scene scene;
  scene.gravity = {0.0, 0.0, -9.81};
  scene.enclosure.size = size;
  scene.packing = PackingKind::random;
  scene.populations.push_back(balls(count, 1.0e-3));
  scene.contact.granule.stiffness = 1.0e7;
  scene.contact.granule.reference_radius = 3.0e-3;
  scene.contact.granule.restitution = 0.8;
  scene.contact.granule.friction = 0.5;
  scene.structure = Structure{.mass = 0.3, .stiffness = 1000.0, .damping = 0.2, .velocity = 0.5};
  scene.time.duration = 150 * 4.0e-6;
  scene.time.step = 4.0e-6;
  scene.verlet.skin = 0.05; // several rebuilds
  return scene;
}

struct Outcome {
  GranuleTable granules;
  Sample sample;
  std::int64_t builds = 0;
  int threads = 0;
  std::size_t segments = 0;
  GuardStatistics guards{};
};

/// So many layers of cells that 20,000 granules and more are cut into eight segments.
constexpr Vector3 tall{0.05, 0.05, 0.15};
constexpr Vector3 small{0.033, 0.033, 0.033};

Outcome finish(Simulation& simulation) {
  while (!simulation.finished()) simulation.step();
  return {simulation.granules(),
          simulation.sample(),
          simulation.verlet().builds,
          simulation.threads(),
          simulation.state().list.segment_blocks.size(),
          simulation.guards()};
}

Outcome run(const Scene& scene, int threads, const std::string& isa) {
  RunOptions options;
  options.threads = threads;
  options.isa = isa;
  Simulation simulation(scene, options);
  return finish(simulation);
}

bool same_bits(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vector3)) == 0;
}

void check_same(const Outcome& a, const Outcome& b) {
  CHECK(same_bits(a.granules.position, b.granules.position));
  CHECK(same_bits(a.granules.velocity, b.granules.velocity));
  CHECK(same_bits(a.granules.spin, b.granules.spin));
  CHECK(a.sample.displacement == b.sample.displacement);
  CHECK(a.sample.stored.kinetic == b.sample.stored.kinetic);
  CHECK(a.sample.stored.elastic == b.sample.stored.elastic);
  CHECK(a.sample.ledger.friction_granule == b.sample.ledger.friction_granule);
  CHECK(a.sample.contacts == b.sample.contacts);
  CHECK(a.builds == b.builds);
  CHECK(a.guards.max_overlap == b.guards.max_overlap);
  CHECK(a.guards.max_closing == b.guards.max_closing);
  CHECK(a.guards.max_speed == b.guards.max_speed);
}

} // namespace

TEST_CASE("the same bits on 1, 2, 3, 4 and 8 threads") {
  const Scene scene = cloud(24000, tall);
  const Outcome alone = run(scene, 1, "");
  CHECK(alone.builds > 3);
  CHECK(alone.sample.contacts > 100);
  CHECK(alone.segments == 8);
  for (const int threads : {2, 3, 4, 8}) {
    CAPTURE(threads);
    const Outcome shared = run(scene, threads, "");
    CHECK(shared.threads == threads);
    check_same(alone, shared);
  }
}

// Pairs across two segments that one thread sweeps are worked off within the sweep, others before it; a list that comes
// from a state has to find out anew when.
TEST_CASE("cut between two lists, on one thread or two: the same bits") {
  Scene scene = cloud(24000, tall);
  scene.verlet.skin = 0.3;
  for (const FrictionLaw friction : {FrictionLaw::coulomb, FrictionLaw::spring}) {
    scene.contact.friction = friction;
    if (friction == FrictionLaw::spring) scene.contact.granule.tangential_stiffness = 0.9e7;
    const Outcome whole = run(scene, 1, "");
    CHECK(whole.segments > 2);
    check_same(whole, run(scene, 2, ""));
    RunOptions options;
    options.threads = 1;
    Simulation first(scene, options);
    while (first.verlet().builds < 2) first.step();
    for (int k = 0; k < 3; ++k) first.step();
    const RunState state = first.state();
    CHECK(state.list_age == 4);
    for (const int threads : {1, 2}) {
      CAPTURE(threads);
      options.threads = threads;
      Simulation second(scene, state, options);
      check_same(whole, finish(second));
    }
  }
}

// Large granules are looked for one by one, and reach through several layers of cells.
TEST_CASE("the same bits on 1, 2 and 4 threads, and from a state, with one in 300 ten times as wide") {
  Scene scene = cloud(21000, {0.06, 0.06, 0.3});
  scene.populations[0] = balls(21000, 0.4e-3);
  scene.populations.push_back(balls(70, 4.0e-3));
  scene.time.step = 1.0e-6;
  scene.time.duration = 150.0e-6;
  scene.verlet.skin = 0.01;
  const Outcome alone = run(scene, 1, "");
  CHECK(alone.builds > 2);
  CHECK(alone.segments > 2);
  CHECK(alone.sample.contacts > 20);
  for (const int threads : {2, 4}) check_same(alone, run(scene, threads, ""));
  scene.verlet.cell = 1.1; // one level: the same pairs in another order
  const Outcome one_level = run(scene, 1, "");
  CHECK(one_level.sample.contacts == alone.sample.contacts);
  CHECK(one_level.sample.stored.kinetic == doctest::Approx(alone.sample.stored.kinetic).epsilon(1e-9));
  scene.verlet.cell.reset();
  RunOptions options;
  options.threads = 1;
  Simulation first(scene, options);
  while (first.verlet().builds < 2) first.step();
  Simulation second(scene, first.state(), options);
  check_same(alone, finish(second));
}

TEST_CASE("the same bits on 1 and 2 threads with two sizes and the verlet integrator") {
  Scene scene = cloud(16000, tall);
  scene.populations.push_back(balls(6000, 0.8e-3));
  scene.time.integrator = Integrator::verlet;
  check_same(run(scene, 1, ""), run(scene, 2, ""));
}

TEST_CASE("mixed precision: the same bits on 1, 2 and 4 threads, and other bits than in double") {
  Scene scene = cloud(24000, tall);
  const Outcome full = run(scene, 2, "");
  scene.time.precision = Precision::mixed;
  const Outcome alone = run(scene, 1, "");
  CHECK(alone.sample.contacts > 100);
  CHECK_FALSE(same_bits(alone.granules.velocity, full.granules.velocity));
  for (const int threads : {2, 4}) {
    CAPTURE(threads);
    check_same(alone, run(scene, threads, ""));
  }
}

TEST_CASE("AVX2 and AVX-512 give the same bits") {
  if (!kernels::available(kernels::InstructionSet::avx512)) {
    MESSAGE("skipped: this machine does not run AVX-512");
    return;
  }
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    Scene scene = cloud(3000, small);
    scene.time.precision = precision;
    check_same(run(scene, 1, "avx2"), run(scene, 1, "avx512"));
    for (const double radius : {0.8e-3, 0.2e-3}) {
      scene.populations.push_back(balls(500, radius));
      scene.time.step = 5.0e-3 * radius; // s, as the duration of contacts falls
      check_same(run(scene, 1, "avx2"), run(scene, 1, "avx512"));
    }
  }
}

TEST_CASE("a few granules stay on one thread unless told otherwise") {
  CHECK(run(cloud(500, small), 0, "").threads == 1);
}

} // namespace grandamp::test

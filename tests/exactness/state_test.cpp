// A run taken out as a state and put into another Simulation goes on by the same bits: every field of the state, every
// sample and statistic, at the end of it.
#include "solver/run_state.hpp"
#include "tests/support/cut_runs.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

using namespace grandamp;
using namespace grandamp::test;

namespace {

Scene damper(std::size_t count) {
  Scene scene = table_5(count, 1.0);
  scene.time.step = 1.0e-5;
  return scene;
}

} // namespace

TEST_CASE("a state put back goes on by the same bits: structure, tuned skin, ledger") {
  for (const int threads : {1, 2}) check_cut(damper(120), 6000, 7, threads, 3 - threads);
}

TEST_CASE("a state put back goes on by the same bits: integrators") {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Scene scene = damper(60);
    scene.time.integrator = integrator;
    scene.output.energy = integrator == Integrator::leapfrog;
    check_cut(scene, 3000, 4);
  }
}

TEST_CASE("a state put back goes on by the same bits: tangential springs") {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Scene scene = damper(100);
    scene.time.integrator = integrator;
    scene.contact.friction = FrictionLaw::spring;
    scene.contact.tension = integrator == Integrator::verlet;
    scene.contact.granule.tangential_stiffness = 0.9e7;
    scene.contact.wall->tangential_stiffness = 1.1e7;
    scene.contact.wall->tangential_damping = 0.02;
    scene.time.step = 5.0e-6;
    check_cut(scene, 6000, 7, 1, 2);
  }
}

TEST_CASE("a state put back goes on by the same bits: list policies, audited") {
  for (const ListPolicy policy : {ListPolicy::guarded, ListPolicy::predicted, ListPolicy::displacement,
                                  ListPolicy::fixed, ListPolicy::none, ListPolicy::all_pairs}) {
    CAPTURE(static_cast<int>(policy));
    Scene scene = damper(60);
    scene.verlet.policy = policy;
    scene.verlet.audit = 10;
    scene.verlet.skin = 0.03;
    if (policy == ListPolicy::fixed) scene.verlet.interval = 90; // so seldom that contacts are missed
    check_cut(scene, 5000, 5);
  }
}

TEST_CASE("a state put back goes on by the same bits: contacts that the list missed are remembered") {
  Scene scene = gas(150, 0.03, 1.5, 4);
  scene.time.step = 4.0e-6;
  scene.verlet.policy = ListPolicy::fixed;
  scene.verlet.interval = 40;
  scene.verlet.skin = 0.1;
  scene.verlet.audit = 1;
  scene.time.impact_speed = 10.0;
  scene.time.duration = 3000 * 4.0e-6;
  Simulation run(scene, with_threads(1));
  std::size_t remembered = 0;
  for (int k = 0; k < 1500 && remembered == 0; ++k) {
    run.step();
    remembered = run.state().unlisted.size();
  }
  REQUIRE(remembered > 0);
  const std::int64_t there = run.step_number();
  Simulation again(scene, run.state(), with_threads(1));
  while (run.step_number() < there + 100) {
    run.step();
    again.step();
  }
  CHECK(differences(run.state(), again.state()) == "");
}

TEST_CASE("a state put back goes on by the same bits: cylinder, prescribed motion, populations") {
  Scene scene = gas(80, 0.03, 1.0, 9);
  scene.enclosure.shape = EnclosureShape::cylinder;
  scene.enclosure.diameter = 0.05;
  scene.enclosure.height = 0.03;
  for (Vector3& p : scene.populations[0].positions) p = {p[0] + 0.01, p[1] + 0.01, p[2]};
  Population small = scene.populations[0];
  Population large = scene.populations[0];
  small.name = "small";
  small.radius = 0.8e-3;
  small.mass = sphere_mass(0.8e-3, 2500.0);
  large.name = "large";
  const auto half = static_cast<std::ptrdiff_t>(scene.populations[0].positions.size() / 2);
  for (auto member : {&Population::positions, &Population::velocities, &Population::spins}) {
    (small.*member).erase((small.*member).begin() + half, (small.*member).end());
    (large.*member).erase((large.*member).begin(), (large.*member).begin() + half);
  }
  small.count = small.positions.size();
  large.count = large.positions.size();
  scene.populations = {small, large};
  scene.excitation.kind = ExcitationKind::prescribed;
  scene.excitation.amplitude = 2.0e-3;
  scene.excitation.frequency = 30.0;
  scene.excitation.direction = {0.6, 0.0, 0.8};
  scene.gravity = {0.0, 0.0, -9.81};
  scene.time.step = 3.0e-6;
  scene.time.impact_speed = 5.0;
  check_cut(scene, 6000, 6);
}

TEST_CASE("a state put back goes on by the same bits: nothing but the structure, free and forced") {
  for (const bool forced : {false, true}) {
    Scene scene = bare_structure();
    if (!forced) {
      scene.excitation = {};
      scene.structure->displacement = 1e-3;
    }
    scene.time.step = 1.0e-4;
    scene.time.duration = 1.0;
    Simulation whole(scene), first(scene);
    go(whole, 10000);
    go(first, 7013);
    Simulation second(scene, first.state());
    go(second, 10000 - 7013);
    CHECK(differences(whole.state(), second.state()) == "");
    CHECK(same(whole.sample(), second.sample()));
    CHECK(whole.response().cycle_amplitudes == second.response().cycle_amplitudes);
    CHECK(whole.response().cycle_amplitudes.size() >= 7);
  }
}

TEST_CASE("a state put back goes on by the same bits: foundation, chirp, random force, impulse and tables") {
  std::vector<Excitation> all(6);
  all[0].kind = ExcitationKind::base;
  all[0].acceleration = 8.0;
  all[0].frequency = 15.0;
  all[1].kind = ExcitationKind::chirp;
  all[1].static_deflection = 0.5e-3;
  all[1].start_frequency = 10.0;
  all[1].end_frequency = 200.0;
  all[1].sweep = Sweep::logarithmic;
  all[1].sweep_duration = 0.021;
  all[2].kind = ExcitationKind::random;
  all[2].force_rms = 2.0;
  all[2].band = {30.0, 3000.0}; // cells and blocks that come and go within the run
  all[2].seed = 3;
  all[3].kind = ExcitationKind::impulse;
  all[3].force = 30.0;
  all[3].start = 4.0e-3;
  all[3].pulse_duration = 2.0e-3;
  for (const std::size_t k : {4U, 5U}) {
    all[k].kind = ExcitationKind::table;
    all[k].quantity = k == 4 ? TableQuantity::force : TableQuantity::acceleration;
    for (int row = 0; row <= 1010; ++row) {
      all[k].times.push_back(1.0e-3 * row);
      all[k].values.push_back((k == 4 ? 1.0 : 10.0) * std::sin(0.7 * row));
    }
  }
  for (const Excitation& excitation : all) {
    CAPTURE(static_cast<int>(excitation.kind));
    Scene scene = damper(60);
    scene.excitation = excitation;
    check_cut(scene, 3000, 5);
    if (excitation.quantity == TableQuantity::force) continue;
    scene.structure.reset(); // the enclosure's own motion
    check_cut(scene, 3000, 5);
  }
}

TEST_CASE("a state is refused if the table of its excitation has become another") {
  Scene scene = damper(20);
  scene.excitation = {};
  scene.excitation.kind = ExcitationKind::table;
  scene.excitation.times = {0.0, 0.1, 0.2, 0.5};
  scene.excitation.values = {0.0, 1.0, 0.0, 1.0};
  Simulation run(scene, with_threads(1));
  go(run, 10);
  const RunState state = run.state();
  CHECK_NOTHROW(Simulation(scene, state, with_threads(1)));
  scene.excitation.values[3] = 1.5;
  CHECK_THROWS_AS(Simulation(scene, state, with_threads(1)), StateError);
}

TEST_CASE("a chirp keeps its sweep when the run goes on beyond its first end") {
  Scene scene = bare_structure();
  scene.excitation = {};
  scene.excitation.kind = ExcitationKind::chirp;
  scene.excitation.force = 0.5;
  scene.excitation.start_frequency = 10.0;
  scene.excitation.end_frequency = 20.0;
  scene.time.step = 1.0e-3;
  scene.time.duration = 1.0;
  Simulation first(scene);
  go(first, 500);
  first.end_at(2000);
  Simulation second(scene, first.state());
  go(first, 1500);
  go(second, 1500);
  CHECK(differences(first.state(), second.state()) == "");
  scene.excitation.sweep_duration = 1.0;
  scene.time.duration = 2.0;
  Simulation whole(scene);
  go(whole, 2000);
  CHECK(whole.state().enclosure_displacement == first.state().enclosure_displacement);
}

TEST_CASE("a state put back goes on by the same bits: 25,000 granules in several segments, 1 and 2 threads") {
  Scene scene = gas(1, 0.16, 1.0, 1);
  Population& population = scene.populations[0];
  population.positions.clear();
  population.velocities.clear();
  population.spins.clear();
  const double pitch = 3.4e-3;
  for (unsigned n = 0; n < 25000; ++n) {
    const unsigned x = n % 30, y = n / 30 % 30, z = n / 900;
    const double s = 0.7e-3 * ((n * 7919U) % 1000U) - 0.35, t = 0.7e-3 * ((n * 104729U) % 1000U) - 0.35;
    add_granule(scene, {2e-3 + pitch * x, 2e-3 + pitch * y, 2e-3 + pitch * z}, {s, t, s - t});
  }
  scene.enclosure.size = {0.105, 0.105, 0.105};
  scene.time.step = 6.0e-6;
  scene.time.impact_speed = 3.0;
  REQUIRE(population.count == 25000);
  scene.time.duration = 300 * 6.0e-6;
  {
    Simulation run(scene, with_threads(1));
    run.step();
    CHECK(run.state().list.segment_blocks.size() >= 2);
  }
  check_cut(scene, 300, 3, 2, 1);
}

TEST_CASE("a pouring cut at many steps and gone on with comes to the same bed by the same bits") {
  Scene scene = damper(60);
  scene.packing = PackingKind::settled;
  Population& population = scene.populations[0];
  population.placed = false; // by count
  population.positions.clear();
  population.velocities.clear();
  population.spins.clear();
  const Simulation whole(scene, with_threads(1));
  struct Cut {};
  RunState state;
  bool begun = false;
  for (int part = 0, cuts = 0;; ++part) {
    REQUIRE(part < 1000);
    RunOptions options = with_threads(1 + part % 2);
    options.poured_so_far = begun ? &state : nullptr;
    options.pouring_progress = [&, steps = 0](const PouringProgress& now) mutable {
      if (!now.save || ++steps < 37 + 977 * (part % 5)) return;
      RunState saved; // apart from the one that this part began with
      now.save(saved);
      state = std::move(saved);
      begun = true;
      ++cuts;
      throw Cut{};
    };
    try {
      Simulation last(scene, options);
      CHECK(cuts > 5);
      CHECK(differences(whole.state(), last.state()) == "");
      break;
    } catch (const Cut&) {
    }
  }
  Scene other = scene;
  other.populations[0].radius *= 1.01;
  RunOptions options = with_threads(1);
  options.poured_so_far = &state;
  CHECK_THROWS_AS(Simulation(other, options), StateError);
}

TEST_CASE("a run that was to end goes on, and its statistics with it") {
  Scene scene = damper(40);
  scene.time.step = 0x1p-17; // durations are then whole steps without rounding
  scene.output.window = {{0.02, 0.05}};
  scene.time.duration = 8192 * 0x1p-17;
  Simulation whole(scene, with_threads(1));
  scene.time.duration = 6600 * 0x1p-17;
  Simulation shorter(scene, with_threads(1));
  REQUIRE(whole.plan().time_step == shorter.plan().time_step);
  go(whole, 8192);
  go(shorter, 6600);
  CHECK(shorter.finished());
  shorter.sample();
  Simulation longer(scene, shorter.state(), with_threads(1));
  CHECK(longer.finished());
  longer.end_at(8192, scene.output.window);
  go(longer, 8192 - 6600);
  CHECK(differences(whole.state(), longer.state()) == "");
}

TEST_CASE("the window of a run that goes on further holds what can be had of it") {
  Scene scene = bare_structure();
  scene.time.step = 1.0e-4;
  scene.time.duration = 1.0;
  Simulation run(scene);
  go(run, 8000); // of 10,000; the window is the last half
  CHECK_THROWS_AS(run.end_at(7999), std::invalid_argument);
  CHECK_THROWS_AS(run.end_at(12000, {{0.1, 1.0}}), std::invalid_argument);
  Simulation soon(scene, run.state()), late(scene, run.state());
  soon.end_at(12000);
  CHECK(soon.plan().window == std::array<double, 2>{0.5, 1.2});
  late.end_at(20000);
  CHECK(late.plan().window == std::array<double, 2>{1.0, 2.0});
  CHECK(late.state().response_samples == 0);
  CHECK(soon.state().response_samples == run.state().response_samples);
}

TEST_CASE("a state of another scene, or a damaged one, is refused") {
  const Scene scene = [] {
    Scene s = damper(30);
    s.time.duration = 0.02;
    return s;
  }();
  Simulation run(scene, with_threads(1));
  go(run, 500);
  const RunState good = run.state();
  const auto refused = [&](const Scene& of, const RunState& state, const char* why) {
    try {
      Simulation(of, state, with_threads(1));
      const std::string what = why;
      FAIL_CHECK(what);
    } catch (const StateError& error) {
      CHECK_MESSAGE(std::string(error.what()).find(why) != std::string::npos, error.what());
    }
  };
  CHECK_NOTHROW(Simulation(scene, good, with_threads(1)));
  Scene other = scene;
  other.time.step = 0.9e-5;
  refused(other, good, "time step");
  other = scene;
  other.contact.granule.restitution = 0.8;
  refused(other, good, "constants");
  other = scene;
  other.verlet.policy = ListPolicy::displacement;
  refused(other, good, "built_at");

  RunState bad = good;
  bad.fused = true;
  RunOptions generic = with_threads(1);
  generic.isa = "generic";
  CHECK_THROWS_AS(Simulation(scene, bad, generic), StateError);
  bad = good;
  bad.id[3] = bad.id[4];
  refused(scene, bad, "granules/id");
  bad = good;
  bad.list.pairs[1] = 30;
  refused(scene, bad, "list/pairs");
  bad = good;
  bad.list.wall_counts[0] += 1;
  refused(scene, bad, "list/wall");
  bad = good;
  bad.list.block_rows[1] -= 1;
  refused(scene, bad, "list/");
  bad = good;
  bad.position[7] = std::nan("");
  refused(scene, bad, "granules/position");
  bad = good;
  bad.velocity.pop_back();
  refused(scene, bad, "granules/velocity");
  bad = good;
  bad.list.segment_rows.clear();
  refused(scene, bad, "list/segment_rows");
}

// Granules in an enclosure that each of the excitations moves: energy and momentum.
#include "tests/support/momenta.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double pi = std::numbers::pi;

Excitation of_kind(ExcitationKind kind) {
  Excitation e;
  e.kind = kind;
  return e;
}

std::vector<Excitation> all_kinds() {
  std::vector<Excitation> all;
  Excitation base = of_kind(ExcitationKind::base);
  base.amplitude = 1.0e-3;
  base.frequency = 40.0;
  all.push_back(base);
  Excitation chirp = of_kind(ExcitationKind::chirp);
  chirp.force = 8.0;
  chirp.start_frequency = 20.0;
  chirp.end_frequency = 80.0;
  chirp.sweep_duration = 0.08;
  all.push_back(chirp);
  Excitation random = of_kind(ExcitationKind::random);
  random.force_rms = 12.0;
  random.band = {10.0, 120.0};
  all.push_back(random);
  Excitation impulse = of_kind(ExcitationKind::impulse);
  impulse.force = 60.0;
  impulse.start = 0.02;
  impulse.pulse_duration = 3.0e-3;
  all.push_back(impulse);
  for (const TableQuantity quantity :
       {TableQuantity::force, TableQuantity::displacement, TableQuantity::acceleration}) {
    Excitation table = of_kind(ExcitationKind::table);
    table.quantity = quantity;
    const double size = quantity == TableQuantity::force          ? 10.0
                        : quantity == TableQuantity::displacement ? 1.0e-3
                                                                  : 60.0;
    for (int row = 0; row <= 600; ++row) {
      const double t = 2.0e-4 * row;
      table.times.push_back(t);
      table.values.push_back(size * std::sin(250.0 * t) * std::cos(37.0 * t));
    }
    all.push_back(table);
  }
  return all;
}

void check_balance(const Scene& scene) {
  SolverRun run(scene);
  const Sample start = run.sample();
  run_all(run, scene);
  const Sample end = run.sample();
  MESSAGE("work in " << end.ledger.work_in << " J, friction " << end.ledger.friction_granule << ", residual "
                     << 100.0 * ledger_residual(start, end) << " %");
  CHECK(std::abs(end.ledger.work_in) > 0.0);
  CHECK(end.ledger.normal_granule > 0.0);
  CHECK(std::abs(ledger_residual(start, end)) < 0.01);
}

} // namespace

TEST_CASE("granules shaken by each excitation: the ledger closes within one percent") {
  for (const Excitation& excitation : all_kinds()) {
    CAPTURE(static_cast<int>(excitation.kind));
    CAPTURE(static_cast<int>(excitation.quantity));
    Scene scene = vertical_damper(60, 1.85e-3, 15.91, 0.1);
    scene.enclosure.size[2] = 0.02;
    scene.excitation = excitation;
    use_step(scene, shortest_contact_duration(scene, 2.0) / 16.0);
    check_balance(scene);
    if (excitation.kind != ExcitationKind::table || excitation.quantity == TableQuantity::force) continue;
    scene.structure.reset();
    check_balance(scene);
  }
}

TEST_CASE("an impulse on a free box of granules gives them and the box 2 F d / pi of momentum") {
  Scene scene = gas(100, 0.022, 0.5, 41);
  scene.structure = Structure{};
  scene.structure->mass = 0.02;
  scene.structure->direction = {0.6, 0.0, 0.8};
  scene.excitation.kind = ExcitationKind::impulse;
  scene.excitation.force = 20.0;
  scene.excitation.start = 1.0e-3;
  scene.excitation.pulse_duration = 2.0e-3;
  scene.time.duration = 6.0e-3;
  use_step(scene, shortest_contact_duration(scene, 3.0) / 8.0);
  SolverRun run(scene);
  const std::vector<double> masses(100, scene.populations[0].mass);
  const auto along = [&] {
    const Sample now = run.sample();
    return dot(momenta(run.granules(), masses).linear, scene.structure->direction) +
           scene.structure->mass * now.velocity;
  };
  const double before = along();
  run_all(run, scene);
  CHECK(run.sample().ledger.normal_wall > 0.0);
  // The box is held across its direction, so only along it.
  // steps.
  CHECK(along() - before == doctest::Approx(2.0 * 20.0 * 2.0e-3 / pi).epsilon(1.0e-9));
}

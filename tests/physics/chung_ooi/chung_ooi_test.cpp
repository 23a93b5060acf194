// Chung & Ooi's benchmarks of single impacts, each within two tolerances: of the closed form (or the published curve),
// and of what this program gave last.
#include "tests/physics/chung_ooi/impact.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

using namespace grandamp;
using namespace grandamp::test;
using namespace grandamp::test::chung_ooi;

namespace {

constexpr double steps_per_contact = 400.0;
constexpr double closed_form_tolerance = 0.01;
constexpr double last_result_tolerance = 1.0e-6;

/// The sphere on its way along -z to a floor, or to a twin that comes the other way.
Scene impact(const Material& material, double radius, double speed, Partner partner) {
  const double side = 40.0 * radius, gap = 1.0e-9;
  Scene scene = box_scene(side, radius);
  Population& sphere = scene.populations[0];
  sphere.mass = sphere_mass(radius, material.density);
  sphere.young = material.young;
  sphere.poisson = material.poisson;
  scene.contact = Contact{};
  scene.contact.damping = NormalDamping::none;
  scene.contact.friction = FrictionLaw::none;
  if (partner == Partner::twin) {
    add_granule(scene, {0.5 * side, 0.5 * side, 0.5 * side + radius + gap}, {0.0, 0.0, -0.5 * speed});
    add_granule(scene, {0.5 * side, 0.5 * side, 0.5 * side - radius}, {0.0, 0.0, 0.5 * speed});
  } else {
    add_granule(scene, {0.5 * side, 0.5 * side, radius + gap}, {0.0, 0.0, -speed});
    scene.contact.wall.emplace();
    scene.contact.wall->young = (partner == Partner::rigid_wall ? 1.0e9 : 1.0e3) * material.young;
    scene.contact.wall->poisson = material.poisson;
  }
  scene.time.impact_speed = speed;
  scene.time.steps_per_contact = steps_per_contact;
  scene.time.duration = 1.0; // cut to the contact by the caller
  return scene;
}

void last_for(Scene& scene, double contacts) {
  scene.time.duration = contacts * make_plan(scene).contact_duration;
}

void check(double found, double expected, double last, const char* what) {
  CAPTURE(what);
  CHECK(found == doctest::Approx(expected).epsilon(closed_form_tolerance));
  CHECK(found == doctest::Approx(last).epsilon(last_result_tolerance));
}

const std::vector<ElasticImpact>& elastic_impacts() {
  static const std::vector<ElasticImpact> all{
      {"1: glass spheres", glass, 0.01, 20.0, Partner::twin, {2.741127e-4, 10696.89, 4.033952e-5}, {}},
      {"1: limestone spheres", limestone, 0.01, 20.0, Partner::twin, {3.68304e-4, 7108.24, 5.420109e-5}, {}},
      {"2: aluminium alloy, rigid wall",
       aluminium_alloy,
       0.1,
       0.2,
       Partner::rigid_wall,
       {4.971718e-5, 11369.86, 7.316578e-4},
       {}},
      {"2: magnesium alloy, rigid wall",
       magnesium_alloy,
       0.1,
       0.2,
       Partner::rigid_wall,
       {5.212329e-5, 7232.68, 7.670671e-4},
       {}},
      {"3: aluminium oxide, lossless",
       aluminium_oxide,
       0.0025,
       3.9,
       Partner::wall_a_thousand_times_stiffer,
       {8.092e-6, 615.1, 6.107e-6},
       {}},
      {"3: cast iron, lossless",
       cast_iron,
       0.0025,
       3.9,
       Partner::wall_a_thousand_times_stiffer,
       {1.7196e-5, 506.6, 1.298e-5},
       {}}};
  return all;
}

} // namespace

TEST_CASE("Chung & Ooi 1 to 3: elastic impacts of spheres on each other and on a wall") {
  for (const ElasticImpact& hit : elastic_impacts()) {
    CAPTURE(hit.name);
    Scene scene = impact(hit.material, hit.radius, hit.closing_speed, hit.partner);
    last_for(scene, 1.2);
    SolverRun run(scene);
    Peak found{0.0, 0.0, 0.0};
    double elastic = 0.0;
    while (!run.simulation().finished()) {
      const Sample now = run.step_and_sample();
      elastic = std::max(elastic, now.stored.elastic);
      if (now.contacts > 0) found.duration += run.time_step();
    }
    found.overlap = run.simulation().guards().max_overlap * hit.radius;
    found.force = 2.5 * elastic / found.overlap; // Hertz: the energy is 2/5 F d
    MESSAGE(doctest::String(std::string(hit.name).c_str()) << ": {" << doctest::toString(found.overlap * 1e9) << "e-9, "
                                                           << found.force << ", " << found.duration * 1e9 << "e-9}");
    check(found.overlap, hit.closed_form.overlap, hit.last.overlap, "overlap");
    check(found.force, hit.closed_form.force, hit.last.force, "force");
    check(found.duration, hit.closed_form.duration, hit.last.duration, "duration");
  }
}

TEST_CASE("Chung & Ooi 3: the restitution that comes out is the one that went in") {
  for (const Material& material : {aluminium_oxide, cast_iron})
    for (const bool tension : {true, false})
      for (int tenths = 2; tenths <= 10; ++tenths) {
        const double e = 0.1 * tenths;
        Scene scene = impact(material, 0.0025, 3.9, Partner::wall_a_thousand_times_stiffer);
        scene.contact.damping = NormalDamping::tsuji;
        scene.contact.tension = tension;
        scene.contact.granule.restitution = e;
        scene.contact.wall->restitution = e;
        last_for(scene, 3.0);
        SolverRun run(scene);
        while (!run.simulation().finished()) run.step();
        CHECK(run.granules().velocity[0][2] / 3.9 == doctest::Approx(e).epsilon(closed_form_tolerance));
      }
}

TEST_CASE("Chung & Ooi 4: oblique impacts from rolling to sliding") {
  const std::vector<std::pair<ObliqueImpact, ObliqueImpact>> hits{
      // Published or closed form, and this program's last.
      {{5.0, 0.948, -19.0, 3.8, false}, {}},     {{10.0, 0.687, -213.0, -1.6, false}, {}},
      {{15.0, 0.624, -378.0, -5.5, false}, {}},  {{20.0, 0.616, -511.0, -7.5, false}, {}},
      {{25.0, 0.634, -599.0, -7.5, false}, {}},  {{30.0, 0.684, -617.0, -3.5, false}, {}},
      {{35.0, 0.737, -582.0, 3.4, false}, {}},   {{40.0, 0.7829, -544.2, 11.62, true}, {}},
      {{50.0, 0.8471, -456.7, 29.49, true}, {}}, {{60.0, 0.8948, -355.2, 48.16, true}, {}},
      {{70.0, 0.9337, -243.0, 65.09, true}, {}}, {{80.0, 0.9679, -123.4, 78.98, true}, {}},
      {{85.0, 0.9841, -61.9, 84.81, true}, {}}};
  constexpr double radius = 0.0025, speed = 3.9, friction = 0.092;
  for (const auto& [expected, last] : hits) {
    CAPTURE(expected.degrees);
    const double angle = expected.degrees * std::numbers::pi / 180.0;
    Scene scene = impact(aluminium_oxide, radius, speed * std::cos(angle), Partner::wall_a_thousand_times_stiffer);
    scene.populations[0].velocities[0][0] = speed * std::sin(angle);
    scene.contact.damping = NormalDamping::tsuji;
    scene.contact.friction = FrictionLaw::spring;
    scene.contact.granule.restitution = scene.contact.wall->restitution = 0.98;
    scene.contact.granule.friction = scene.contact.wall->friction = friction;
    last_for(scene, 1.3);
    SolverRun run(scene);
    while (!run.simulation().finished()) run.step();
    const GranuleTable end = run.granules();
    ObliqueImpact found;
    found.tangential_restitution = end.velocity[0][0] / (speed * std::sin(angle));
    found.spin = -end.spin[0][1]; // forward rolling is about +y here, and about the other way in the paper
    const double slip = end.velocity[0][0] - radius * end.spin[0][1];
    found.rebound_degrees = std::atan2(slip, end.velocity[0][2]) * 180.0 / std::numbers::pi;
    MESSAGE(expected.degrees << " degrees: " << found.tangential_restitution << ", " << found.spin << ", "
                             << found.rebound_degrees << "; published " << expected.tangential_restitution << ", "
                             << expected.spin << ", " << expected.rebound_degrees);
    const double restitution_band = expected.slides_throughout ? closed_form_tolerance : 0.03;
    CHECK(found.tangential_restitution == doctest::Approx(expected.tangential_restitution).epsilon(restitution_band));
    const double spin_band = expected.slides_throughout ? 6.0 : 25.0; // rad/s: 1 % and 4 % of the largest
    CHECK(std::abs(found.spin - expected.spin) < spin_band);
    CHECK(std::abs(found.rebound_degrees - expected.rebound_degrees) < (expected.slides_throughout ? 0.5 : 1.5));
    CHECK(found.tangential_restitution == doctest::Approx(last.tangential_restitution).epsilon(last_result_tolerance));
    CHECK(found.spin == doctest::Approx(last.spin).epsilon(last_result_tolerance));
    CHECK(found.rebound_degrees == doctest::Approx(last.rebound_degrees).epsilon(last_result_tolerance));
  }
}

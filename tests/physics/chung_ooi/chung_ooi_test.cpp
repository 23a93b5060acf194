// Chung & Ooi's benchmarks of single impacts, each within two tolerances: of the closed form (or the published curve),
// and of what this program gave last.
#include "tests/physics/chung_ooi/impact.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

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
  static const std::vector<ElasticImpact> all{{"1: glass spheres",
                                               glass,
                                               0.01,
                                               20.0,
                                               Partner::twin,
                                               {2.741127e-4, 10696.89, 4.033952e-5},
                                               {0.000274113507, 10696.9361, 4.03386351e-05}},
                                              {"1: limestone spheres",
                                               limestone,
                                               0.01,
                                               20.0,
                                               Partner::twin,
                                               {3.68304e-4, 7108.24, 5.420109e-5},
                                               {0.000368305107, 7108.2726, 5.41999024e-05}},
                                              {"2: aluminium alloy, rigid wall",
                                               aluminium_alloy,
                                               0.1,
                                               0.2,
                                               Partner::rigid_wall,
                                               {4.971718e-5, 11369.86, 7.316578e-4},
                                               {4.97173211e-05, 11369.9083, 0.000731641758}},
                                              {"2: magnesium alloy, rigid wall",
                                               magnesium_alloy,
                                               0.1,
                                               0.2,
                                               Partner::rigid_wall,
                                               {5.212329e-5, 7232.68, 7.670671e-4},
                                               {5.21234412e-05, 7232.71285, 0.000767050302}},
                                              {"3: aluminium oxide, lossless",
                                               aluminium_oxide,
                                               0.0025,
                                               3.9,
                                               Partner::wall_a_thousand_times_stiffer,
                                               {8.092e-6, 615.1, 6.107e-6},
                                               {8.09206629e-06, 615.108277, 6.10682675e-06}},
                                              {"3: cast iron, lossless",
                                               cast_iron,
                                               0.0025,
                                               3.9,
                                               Partner::wall_a_thousand_times_stiffer,
                                               {1.7196e-5, 506.6, 1.298e-5},
                                               {1.71956373e-05, 506.559892, 1.29770039e-05}}};
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
    MESSAGE(fmt::format("{}: {{{:.9g}, {:.9g}, {:.9g}}}", hit.name, found.overlap, found.force, found.duration));
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

namespace {

constexpr double oblique_radius = 0.0025, oblique_speed = 3.9, oblique_friction = 0.092, oblique_restitution = 0.98;

Scene oblique_impact(double angle) {
  Scene scene =
      impact(aluminium_oxide, oblique_radius, oblique_speed * std::cos(angle), Partner::wall_a_thousand_times_stiffer);
  scene.populations[0].velocities[0][0] = oblique_speed * std::sin(angle);
  scene.contact.damping = NormalDamping::tsuji;
  scene.contact.friction = FrictionLaw::spring;
  scene.contact.granule.restitution = scene.contact.wall->restitution = oblique_restitution;
  scene.contact.granule.friction = scene.contact.wall->friction = oblique_friction;
  last_for(scene, 1.3);
  return scene;
}

/// Centre's velocity along x and z after the hit, and the velocity of the surface, forward rolling negative (m/s).
ObliqueImpact outcome(double angle, double vx, double vz, double rolling) {
  return {angle * 180.0 / std::numbers::pi, vx / (oblique_speed * std::sin(angle)), rolling / oblique_radius,
          std::atan2(vx + rolling, vz) * 180.0 / std::numbers::pi, false};
}

/// The same hit by the spring as published programs have it, f = -k_t sqrt(d) s at most mu F_n, in a loop of its own.
ObliqueImpact with_plain_spring(double angle) {
  const Material& m = aluminium_oxide;
  const double mass = sphere_mass(oblique_radius, m.density);
  const double modulus = m.young / (1.0 - m.poisson * m.poisson) / (1.0 + 1.0e-3);
  const double shear = m.young / (2.0 * (1.0 + m.poisson) * (2.0 - m.poisson)) / (1.0 + 1.0e-3);
  const double stiffness = 4.0 / 3.0 * modulus * std::sqrt(oblique_radius);
  const double tangential = 8.0 * shear * std::sqrt(oblique_radius);
  const double logarithm = std::log(oblique_restitution);
  const double alpha = -std::sqrt(5.0) * logarithm / std::hypot(logarithm, std::numbers::pi);
  double vx = oblique_speed * std::sin(angle), vz = -oblique_speed * std::cos(angle), rolling = 0.0;
  double overlap = 0.0, stretch = 0.0;
  const double step = 1.0e-10;
  do {
    overlap -= vz * step;
    stretch += (vx + rolling) * step;
    const double root = std::sqrt(std::max(0.0, overlap));
    const double normal = stiffness * overlap * root - alpha * std::sqrt(mass * stiffness * root) * vz;
    double force = tangential * root * stretch;
    const double most = oblique_friction * std::abs(normal);
    if (std::abs(force) > most) {
      force = std::copysign(most, force);
      stretch = force / (tangential * root);
    }
    vz += normal / mass * step;
    vx -= force / mass * step;
    rolling -= 2.5 * force / mass * step;
  } while (overlap > 0.0);
  return outcome(angle, vx, vz, rolling);
}

} // namespace

TEST_CASE("Chung & Ooi 4: oblique impacts from rolling to sliding") {
  const std::vector<std::pair<ObliqueImpact, ObliqueImpact>> hits{
      // Published or closed form, and this program's last.
      {{5.0, 0.948, -19.0, 3.8, false}, {5.0, 0.859883706, -47.4742279, 2.61046415, false}},
      {{10.0, 0.687, -213.0, -1.6, false}, {10.0, 0.707309809, -197.632423, -0.229412285, false}},
      {{15.0, 0.624, -378.0, -5.5, false}, {15.0, 0.628911067, -373.491359, -4.62885847, false}},
      {{20.0, 0.616, -511.0, -7.5, false}, {20.0, 0.618405314, -507.609324, -7.0496102, false}},
      {{25.0, 0.634, -599.0, -7.5, false}, {25.0, 0.637239487, -596.39826, -7.2502973, false}},
      {{30.0, 0.684, -617.0, -3.5, false}, {30.0, 0.684480876, -613.822754, -3.45465388, false}},
      {{35.0, 0.737, -582.0, 3.4, false}, {35.0, 0.739829681, -580.685161, 3.71429925, false}},
      {{40.0, 0.7829, -544.2, 11.62, true}, {40.0, 0.782891875, -543.107892, 11.6719806, true}},
      {{50.0, 0.8471, -456.7, 29.49, true}, {50.0, 0.847136747, -455.848413, 29.5227095, true}},
      {{60.0, 0.8948, -355.2, 48.16, true}, {60.0, 0.894821041, -354.706269, 48.1749337, true}},
      {{70.0, 0.9337, -243.0, 65.09, true}, {70.0, 0.933693634, -242.729279, 65.0907388, true}},
      {{80.0, 0.9679, -123.4, 78.98, true}, {80.0, 0.967877618, -123.294234, 78.9834111, true}},
      {{85.0, 0.9841, -61.9, 84.81, true}, {85.0, 0.984061771, -61.8994826, 84.8115233, true}}};
  /// Deviations over the published values, summed; digitised curves are held to the shares that are stated for them.
  double restitution_off = 0.0, spin_off = 0.0, rebound_off = 0.0, restitutions = 0.0, spins = 0.0, rebounds = 0.0;
  for (const auto& [expected, last] : hits) {
    CAPTURE(expected.degrees);
    const double angle = expected.degrees * std::numbers::pi / 180.0;
    SolverRun run(oblique_impact(angle));
    while (!run.simulation().finished()) run.step();
    const GranuleTable end = run.granules();
    const ObliqueImpact found =
        outcome(angle, end.velocity[0][0], end.velocity[0][2], -oblique_radius * end.spin[0][1]);
    MESSAGE(fmt::format("{} degrees: {:.9g}, {:.9g}, {:.9g}; published {}, {}, {}", expected.degrees,
                        found.tangential_restitution, found.spin, found.rebound_degrees,
                        expected.tangential_restitution, expected.spin, expected.rebound_degrees));
    if (expected.slides_throughout) {
      CHECK(found.tangential_restitution ==
            doctest::Approx(expected.tangential_restitution).epsilon(closed_form_tolerance));
      CHECK(found.spin == doctest::Approx(expected.spin).epsilon(closed_form_tolerance));
      CHECK(found.rebound_degrees == doctest::Approx(expected.rebound_degrees).epsilon(closed_form_tolerance));
    }
    restitution_off += std::abs(found.tangential_restitution - expected.tangential_restitution);
    spin_off += std::abs(found.spin - expected.spin);
    rebound_off += std::abs(found.rebound_degrees - expected.rebound_degrees);
    restitutions += expected.tangential_restitution;
    spins += std::abs(expected.spin);
    rebounds += std::abs(expected.rebound_degrees);
    CHECK(found.tangential_restitution == doctest::Approx(last.tangential_restitution).epsilon(last_result_tolerance));
    CHECK(found.spin == doctest::Approx(last.spin).epsilon(last_result_tolerance));
    CHECK(found.rebound_degrees == doctest::Approx(last.rebound_degrees).epsilon(last_result_tolerance));
  }
  MESSAGE(fmt::format("off the published curves by {:.2f} % (restitution), {:.2f} % (spin), {:.2f} % (rebound)",
                      100.0 * restitution_off / restitutions, 100.0 * spin_off / spins,
                      100.0 * rebound_off / rebounds));
  CHECK(restitution_off / restitutions < 0.016);
  CHECK(spin_off / spins < 0.022);
  CHECK(rebound_off / rebounds < 0.025);
}

TEST_CASE("Chung & Ooi 4, sticking: what the spring that makes no energy changes at small angles") {
  // At 5 degrees the contact never slides on its way in. The published curve has the spring f = -k_t sqrt(d) s, which
  // this loop has too and which gives more back than it took; ours lies below. From 10 degrees on they agree.
  const ObliqueImpact plain = with_plain_spring(5.0 * std::numbers::pi / 180.0);
  MESSAGE(fmt::format("5 degrees by f = -k_t sqrt(d) s: {:.4f}, {:.2f}, {:.3f}; published 0.948, -19, 3.8",
                      plain.tangential_restitution, plain.spin, plain.rebound_degrees));
  CHECK(plain.tangential_restitution == doctest::Approx(0.948).epsilon(0.016));
  for (const double degrees : {20.0, 30.0, 40.0, 60.0}) {
    CAPTURE(degrees);
    const double angle = degrees * std::numbers::pi / 180.0;
    SolverRun run(oblique_impact(angle));
    while (!run.simulation().finished()) run.step();
    const ObliqueImpact other = with_plain_spring(angle);
    CHECK(run.granules().velocity[0][0] / (oblique_speed * std::sin(angle)) ==
          doctest::Approx(other.tangential_restitution).epsilon(0.01));
  }
}

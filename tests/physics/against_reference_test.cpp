// Whole runs beside the oracle's, step for step, in every combination of laws, shapes and hosts that a scene can ask
// for, before chaos parts them.
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>

using namespace grandamp;
using namespace grandamp::test;

namespace {

struct Variation {
  std::string name;
  std::function<void(Scene&)> change;
};

/// 60 granules on the floor of Table 5's box, stirred, with spins.
Scene stirred_bed() {
  Scene scene = table_5(60, 3.0e-3);
  Population& population = scene.populations[0];
  for (std::size_t i = 0; i < population.positions.size(); ++i) {
    const auto phase = static_cast<double>(i);
    population.velocities[i] = {0.3 * std::sin(1.7 * phase), 0.3 * std::sin(2.9 * phase + 1.0),
                                0.3 * std::sin(4.1 * phase + 2.0) - 0.2};
    population.spins[i] = {60.0 * std::cos(phase), -40.0 * std::sin(2.0 * phase), 80.0 * std::cos(3.0 * phase)};
  }
  scene.structure->velocity = 0.4;
  use_step(scene, shortest_contact_duration(scene, 1.0) / 8.0);
  return scene;
}

void put_in_cylinder(Scene& scene, int axis) {
  // The bed fits a cylinder of 36 mm if its middle is moved to the cylinder's.
  scene.enclosure = {EnclosureShape::cylinder, {0.0, 0.0, 0.0}, 0.036, 0.036, axis};
  for (Vector3& position : scene.populations[0].positions)
    for (std::size_t k = 0; k < 3; ++k) position[k] += k == 2 && axis == 2 ? 0.0 : 0.0055;
  for (std::size_t k = 0; k < 3; ++k)
    for (Vector3& velocity : scene.populations[0].velocities) velocity[k] *= 3.0;
}

void put_on_springs(Scene& scene) {
  scene.contact.friction = FrictionLaw::spring;
  scene.contact.granule.tangential_stiffness = 0.9e7;
  scene.contact.granule.tangential_damping = 0.02;
  scene.contact.wall->tangential_stiffness = 1.1e7;
  scene.contact.wall->tangential_damping = 0.03;
}

void restitute(Scene& scene, double restitution) {
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    constants->alpha.reset();
    constants->restitution = restitution;
  }
}

const std::vector<Variation>& variations() {
  static const std::vector<Variation> all{
      {"as the paper", [](Scene&) {}},
      {"verlet", [](Scene& s) { s.time.integrator = Integrator::verlet; }},
      {"no friction",
       [](Scene& s) {
         s.contact.friction = FrictionLaw::none;
         s.contact.granule.friction.reset();
         s.contact.wall->friction.reset();
         s.contact.rotation = true;
       }},
      {"no rotation", [](Scene& s) { s.contact.rotation = false; }},
      {"no damping",
       [](Scene& s) {
         s.contact.damping = NormalDamping::none;
         s.contact.granule.restitution.reset();
         s.contact.wall->restitution.reset();
       }},
      {"linear damping",
       [](Scene& s) {
         s.contact.damping = NormalDamping::linear;
         s.contact.granule.restitution.reset();
         s.contact.wall->restitution.reset();
         s.contact.granule.normal_damping = 0.3;
         s.contact.wall->normal_damping = 0.5;
       }},
      {"linear damping, verlet, no friction",
       [](Scene& s) {
         make_lossless(s);
         s.contact.damping = NormalDamping::linear;
         s.contact.granule.normal_damping = 0.3;
         s.contact.wall->normal_damping = 0.5;
         s.time.integrator = Integrator::verlet;
       }},
      {"lossless", [](Scene& s) { make_lossless(s); }},
      {"elastic moduli, wall of the granules' material",
       [](Scene& s) {
         s.contact.granule.stiffness.reset();
         s.contact.granule.reference_radius.reset();
         s.contact.wall.reset();
         s.populations[0].young = 3.0e9;
         s.populations[0].poisson = 0.35;
         use_step(s, 2.0e-6);
       }},
      {"elastic moduli, a stiffer wall",
       [](Scene& s) {
         s.contact.granule.stiffness.reset();
         s.contact.granule.reference_radius.reset();
         s.contact.wall->stiffness.reset();
         s.contact.wall->reference_radius.reset();
         s.contact.wall->young = 2.0e11;
         s.contact.wall->poisson = 0.29;
         use_step(s, 2.0e-6);
         s.populations[0].young = 3.0e9;
         s.populations[0].poisson = 0.35;
       }},
      {"many radii and masses",
       [](Scene& s) {
         Population& p = s.populations[0];
         for (std::size_t i = 0; i < p.positions.size(); ++i) {
           p.radii.push_back(p.radius * (1.0 - 0.1 * static_cast<double>(i % 5)));
           p.masses.push_back(sphere_mass(p.radii.back(), i % 3 ? 1190.0 : 4000.0));
         }
         for (Vector3& velocity : p.velocities) velocity[2] -= 0.5;
       }},
      {"two populations of unlike moduli",
       [](Scene& s) {
         s.contact.granule.stiffness.reset();
         s.contact.granule.reference_radius.reset();
         s.populations[0].young = 3.0e9;
         s.populations[0].poisson = 0.35;
         Population half = s.populations[0];
         half.name = "steel";
         half.young = 3.0e10;
         half.poisson = 0.29;
         half.mass *= 5.0;
         use_step(s, 2.0e-6);
         for (auto member : {&Population::positions, &Population::velocities, &Population::spins}) {
           (half.*member).erase((half.*member).begin(), (half.*member).begin() + 40);
           (s.populations[0].*member).resize(40);
         }
         half.count = 20;
         s.populations[0].count = 40;
         s.populations.push_back(half);
       }},
      {"a light structure, slanting",
       [](Scene& s) {
         s.structure->mass = 2.0e-4;
         s.structure->stiffness = 200.0;
         s.structure->direction = {0.6, 0.0, 0.8};
       }},
      {"a prescribed motion",
       [](Scene& s) {
         s.structure.reset();
         s.excitation = Excitation{};
         s.excitation.kind = ExcitationKind::prescribed;
         s.excitation.amplitude = 1.0e-3;
         s.excitation.frequency = 90.0;
         s.excitation.direction = {0.0, 0.6, 0.8};
       }},
      {"a prescribed velocity, verlet",
       [](Scene& s) {
         s.structure.reset();
         s.excitation = Excitation{};
         s.excitation.kind = ExcitationKind::prescribed;
         s.excitation.velocity = 1.0;
         s.time.integrator = Integrator::verlet;
       }},
      {"a still enclosure, no gravity",
       [](Scene& s) {
         s.structure.reset();
         s.excitation = Excitation{};
         s.gravity = {0.0, 0.0, 0.0};
       }},
      {"springs", put_on_springs},
      {"springs, verlet",
       [](Scene& s) {
         put_on_springs(s);
         s.time.integrator = Integrator::verlet;
       }},
      {"springs, no rotation, a list from all pairs",
       [](Scene& s) {
         put_on_springs(s);
         s.contact.rotation = false;
         s.verlet.policy = ListPolicy::all_pairs;
       }},
      {"springs in a cylinder, several sizes, rebuilds at every step",
       [](Scene& s) {
         put_on_springs(s);
         put_in_cylinder(s, 0);
         Population& p = s.populations[0];
         for (std::size_t i = 0; i < p.positions.size(); ++i)
           p.radii.push_back(p.radius * (1.0 - 0.05 * static_cast<double>(i % 3)));
         s.verlet.policy = ListPolicy::none;
       }},
      {"without tension",
       [](Scene& s) {
         s.contact.tension = false;
         restitute(s, 0.2);
       }},
      {"springs without tension, verlet",
       [](Scene& s) {
         put_on_springs(s);
         s.contact.tension = false;
         restitute(s, 0.4);
         s.time.integrator = Integrator::verlet;
       }},
      {"linear damping without tension",
       [](Scene& s) {
         s.contact.tension = false;
         s.contact.damping = NormalDamping::linear;
         s.contact.granule.alpha.reset();
         s.contact.wall->alpha.reset();
         s.contact.granule.restitution.reset();
         s.contact.wall->restitution.reset();
         s.contact.granule.normal_damping = 0.8;
         s.contact.wall->normal_damping = 0.8;
       }},
      {"a cylinder along x", [](Scene& s) { put_in_cylinder(s, 0); }},
      {"a cylinder along y", [](Scene& s) { put_in_cylinder(s, 1); }},
      {"a cylinder along z", [](Scene& s) { put_in_cylinder(s, 2); }},
  };
  return all;
}

double relative(double a, double b, double scale) {
  return std::abs(a - b) / scale;
}

} // namespace

TEST_CASE("runs of every combination of laws stay beside the oracle's") {
  for (const Variation& variation : variations()) {
    CAPTURE(variation.name);
    Scene scene = stirred_bed();
    variation.change(scene);
    SolverRun solver(scene);
    OracleRun oracle(scene);
    REQUIRE(solver.time_step() == doctest::Approx(oracle.time_step()).epsilon(1.0e-14));
    std::int64_t contacts = 0;
    double positions = 0.0, velocities = 0.0, host = 0.0, energies = 0.0, ledger = 0.0;
    std::int64_t unlike_contacts = 0;
    const std::int64_t steps = steps_of(scene);
    for (std::int64_t n = 0; n <= steps; ++n) {
      const bool look = n % 5 == 0 || n == steps || n < 3;
      if (look) {
        const Sample a = solver.sample(), b = oracle.sample();
        contacts += b.contacts;
        unlike_contacts += std::abs(a.contacts - b.contacts);
        const double energy = b.stored.kinetic + b.stored.elastic;
        host = std::max({host, relative(a.displacement, b.displacement, 1.0e-3), relative(a.velocity, b.velocity, 1.0),
                         relative(a.excitation, b.excitation, 1.0), relative(a.reaction, b.reaction, 10.0)});
        for (std::size_t k = 0; k < 3; ++k) host = std::max(host, relative(a.wall_force[k], b.wall_force[k], 10.0));
        energies = std::max({energies, relative(a.stored.kinetic, b.stored.kinetic, energy),
                             relative(a.stored.elastic, b.stored.elastic, energy),
                             relative(a.stored.gravitational, b.stored.gravitational, energy),
                             relative(a.stored.structure, b.stored.structure, energy)});
        ledger = std::max({ledger, relative(a.ledger.work_in, b.ledger.work_in, energy),
                           relative(a.ledger.structural_damping, b.ledger.structural_damping, energy),
                           relative(a.ledger.normal_granule, b.ledger.normal_granule, energy),
                           relative(a.ledger.normal_wall, b.ledger.normal_wall, energy),
                           relative(a.ledger.friction_granule, b.ledger.friction_granule, energy),
                           relative(a.ledger.friction_wall, b.ledger.friction_wall, energy)});
        const GranuleTable ga = solver.granules(), gb = oracle.granules();
        REQUIRE(ga.position.size() == gb.position.size());
        for (std::size_t i = 0; i < ga.position.size(); ++i) {
          positions = std::max(positions, length(difference(ga.position[i], gb.position[i])) / gb.radius[i]);
          velocities = std::max({velocities, length(difference(ga.velocity[i], gb.velocity[i])),
                                 gb.radius[i] * length(difference(ga.spin[i], gb.spin[i]))});
        }
      }
      if (n < steps) {
        solver.step();
        oracle.step();
      }
    }
    CHECK(contacts > 100);
    CHECK(unlike_contacts == 0);
    CHECK(positions < 1.0e-9);
    CHECK(velocities < 1.0e-8);
    CHECK(host < 1.0e-8);
    CHECK(energies < 1.0e-8);
    CHECK(ledger < 1.0e-8);
  }
}

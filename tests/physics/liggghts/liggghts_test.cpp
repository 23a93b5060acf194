// The same scenes in LIGGGHTS, where it is installed: trajectories where the laws are the same, means over seeds where
// contacts are many and the laws of friction differ a little.
#include "tests/io/io_support.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/scenes.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <sstream>

using namespace grandamp;
using namespace grandamp::test;

namespace {

constexpr double young = 3.5e8, wall_young = 3.0e8, poisson = 0.3;

bool installed() {
  static const bool found = std::system("command -v liggghts >/dev/null 2>&1") == 0;
  if (!found) MESSAGE("skipped: there is no program liggghts here (Debian's package of that name)");
  return found;
}

/// Materials by their moduli, which LIGGGHTS wants and both programs make stiffnesses of.
void use_moduli(Scene& scene, double restitution, double friction) {
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) *constants = {};
  scene.populations[0].young = young;
  scene.populations[0].poisson = poisson;
  scene.contact.wall->young = wall_young;
  scene.contact.wall->poisson = poisson;
  scene.contact.friction = friction > 0.0 ? FrictionLaw::spring : FrictionLaw::none;
  scene.contact.damping = restitution < 1.0 ? NormalDamping::tsuji : NormalDamping::none;
  for (ContactConstants* constants : {&scene.contact.granule, &*scene.contact.wall}) {
    if (restitution < 1.0) constants->restitution = restitution;
    if (friction > 0.0) constants->friction = friction;
  }
}

struct Motion {
  std::vector<Vector3> position, velocity, spin;
};

void write_data(const std::filesystem::path& path, const Scene& scene) {
  const Population& population = scene.populations[0];
  const double low = -1e-4, high = scene.enclosure.size[0] + 1e-4;
  std::string text = fmt::format("granules\n\n{} atoms\n2 atom types\n\n", population.count);
  for (const char axis : {'x', 'y', 'z'}) text += fmt::format("{} {} {}lo {}hi\n", low, high, axis, axis);
  text += "\nAtoms\n\n";
  for (std::size_t i = 0; i < population.count; ++i) {
    const Vector3& p = population.positions[i];
    text += fmt::format("{} 1 {} {} {} {} {}\n", i + 1, 2.0 * population.radius, acrylic_density, p[0], p[1], p[2]);
  }
  text += "\nVelocities\n\n";
  for (std::size_t i = 0; i < population.count; ++i) {
    const Vector3 &v = population.velocities[i], &w = population.spins[i];
    text += fmt::format("{} {} {} {} {} {} {}\n", i + 1, v[0], v[1], v[2], w[0], w[1], w[2]);
  }
  write_content(path, text);
}

/// The motion in LIGGGHTS after every `every` steps, the start included.
std::vector<Motion> in_liggghts(const Scene& scene, double step, double restitution, double friction, int every,
                                int steps) {
  const TemporaryFolder folder;
  write_data(folder / "granules.data", scene);
  std::string command = fmt::format("OMP_NUM_THREADS=1 liggghts -in '{}/tests/physics/liggghts/gas.liggghts' -log none",
                                    GRANDAMP_SOURCE_DIR);
  const auto set = [&command](const char* name, const auto& value) {
    command += fmt::format(" -var {} {}", name, value);
  };
  set("data", "granules.data");
  set("states", "states.txt");
  set("skin", 0.5e-3);
  set("young", young);
  set("wall_young", wall_young);
  set("poisson", poisson);
  set("e", restitution);
  set("friction", friction);
  set("step", step);
  set("side", scene.enclosure.size[0]);
  set("every", every);
  set("steps", steps);
  const Outcome outcome = shell(folder, command);
  INFO(outcome.output);
  INFO(outcome.errors);
  REQUIRE(outcome.status == 0);
  std::vector<Motion> motions;
  const std::size_t count = scene.populations[0].count;
  std::istringstream states(content_of(folder / "states.txt"));
  for (std::string line; std::getline(states, line);) {
    if (line.rfind("ITEM: ATOMS", 0) != 0) continue;
    Motion& motion = motions.emplace_back();
    for (auto* rows : {&motion.position, &motion.velocity, &motion.spin}) rows->resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t id = 0;
      states >> id;
      REQUIRE(id == i + 1);
      for (auto* rows : {&motion.position, &motion.velocity, &motion.spin})
        for (double& component : (*rows)[i]) states >> component;
      REQUIRE(states.good());
    }
  }
  REQUIRE(motions.size() == static_cast<std::size_t>(steps / every) + 1);
  return motions;
}

std::vector<Motion> in_grandamp(const Scene& scene, int every, int steps) {
  SolverRun run(scene);
  std::vector<Motion> motions;
  for (int n = 0; n <= steps; ++n) {
    if (n % every == 0) {
      const GranuleTable now = run.granules();
      motions.push_back({now.position, now.velocity, now.spin});
    }
    if (n < steps) run.step();
  }
  return motions;
}

double farthest(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length(difference(a[i], b[i])));
  return largest;
}

double kinetic(const Scene& scene, const Motion& motion) {
  const double mass = scene.populations[0].mass, radius = scene.populations[0].radius;
  double sum = 0.0;
  for (std::size_t i = 0; i < motion.velocity.size(); ++i)
    sum += 0.5 * mass * dot(motion.velocity[i], motion.velocity[i]) +
           0.2 * mass * radius * radius * dot(motion.spin[i], motion.spin[i]);
  return sum;
}

void steps_of(Scene& scene, double step, int steps) {
  scene.time.impact_speed = 8.0;
  scene.time.duration = step * steps;
  scene.time.step = step;
}

struct Mean {
  double value = 0.0, error = 0.0; ///< error: of the mean
};

Mean mean_of(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  double sum = 0.0, square = 0.0;
  for (const double value : values) sum += value;
  for (const double value : values) square += (value - sum / n) * (value - sum / n);
  return {sum / n, std::sqrt(square / (n - 1.0) / n)};
}

} // namespace

TEST_CASE("two granules hit each other and a wall as in LIGGGHTS") {
  if (!installed()) return;
  constexpr double step = 2.0e-6;
  constexpr int every = 50, steps = 4000;
  for (const double restitution : {1.0, 0.89, 0.5}) {
    CAPTURE(restitution);
    Scene scene = box_scene(0.02, 1.5e-3);
    add_granule(scene, {0.0060, 0.0100, 0.0100}, {2.0, 0.1, 0.3});
    add_granule(scene, {0.0115, 0.0108, 0.0093}, {-2.5, 0.2, -0.1});
    use_moduli(scene, restitution, 0.0);
    steps_of(scene, step, steps);
    const std::vector<Motion> theirs = in_liggghts(scene, step, restitution, 0.0, every, steps);
    const std::vector<Motion> ours = in_grandamp(scene, every, steps);
    double apart = 0.0, turned = 0.0;
    for (std::size_t n = 0; n < ours.size(); ++n) {
      apart = std::max(apart, farthest(ours[n].position, theirs[n].position));
      turned = std::max(turned, length(difference(ours[n].velocity[0], ours[0].velocity[0])));
    }
    MESSAGE("restitution " << restitution << ": trajectories of 8 ms apart by at most " << apart << " m");
    CHECK(turned > 1.0); // they did hit
    CHECK(apart < 1.0e-13);
  }
}

TEST_CASE("300 elastic granules move as in LIGGGHTS until chaos has made of rounding what it can") {
  if (!installed()) return;
  constexpr double step = 2.0e-6;
  constexpr int every = 50, steps = 2000;
  Scene scene = gas(300, 0.025, 2.5, 11);
  for (Vector3& spin : scene.populations[0].spins) spin = {};
  scene.populations[0].spins.resize(scene.populations[0].count);
  use_moduli(scene, 1.0, 0.0);
  steps_of(scene, step, steps);
  const std::vector<Motion> theirs = in_liggghts(scene, step, 1.0, 0.0, every, steps);
  const std::vector<Motion> ours = in_grandamp(scene, every, steps);
  std::size_t alike = 0;
  while (alike < ours.size() && farthest(ours[alike].position, theirs[alike].position) < 1.0e-9) ++alike;
  MESSAGE("300 trajectories within 1e-9 m of each other for " << 1e3 * step * every * static_cast<double>(alike - 1)
                                                              << " ms");
  CHECK(static_cast<double>(alike - 1) * every * step >= 3.0e-3);
  std::size_t turned = 0;
  for (std::size_t i = 0; i < 300; ++i)
    turned += length(difference(ours[alike - 1].velocity[i], ours[0].velocity[i])) > 0.1;
  MESSAGE(turned << " of them had hit something by then");
  CHECK(turned > 100);
  const double first = kinetic(scene, ours.front());
  CHECK(kinetic(scene, theirs.back()) / first == doctest::Approx(kinetic(scene, ours.back()) / first).epsilon(0.02));
}

TEST_CASE("300 granules with friction lose their energy as fast as in LIGGGHTS: means over seeds") {
  if (!installed()) return;
  constexpr double step = 2.0e-6, restitution = 0.89, friction = 0.52;
  constexpr int every = 500, steps = 5000;
  const int seeds = full_tests() ? 12 : 4;
  std::vector<std::vector<double>> ours(steps / every + 1), theirs(ours.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    Scene scene = gas(300, 0.025, 2.5, static_cast<std::uint64_t>(seed));
    scene.populations[0].spins.assign(scene.populations[0].count, {});
    use_moduli(scene, restitution, friction);
    steps_of(scene, step, steps);
    const std::vector<Motion> a = in_grandamp(scene, every, steps);
    const std::vector<Motion> b = in_liggghts(scene, step, restitution, friction, every, steps);
    for (std::size_t n = 0; n < ours.size(); ++n) {
      ours[n].push_back(kinetic(scene, a[n]) / kinetic(scene, a[0]));
      theirs[n].push_back(kinetic(scene, b[n]) / kinetic(scene, b[0]));
    }
  }
  for (std::size_t n = 1; n < ours.size(); ++n) {
    const Mean here = mean_of(ours[n]), there = mean_of(theirs[n]);
    MESSAGE(fmt::format("{:.0f} ms: E/E0 = {:.4f} +- {:.4f}, LIGGGHTS {:.4f} +- {:.4f}",
                        1e3 * step * every * static_cast<double>(n), here.value, here.error, there.value, there.error));
    // Theirs has a dashpot beside the tangential spring, and a spring that may give back more than it took.
    CHECK(std::abs(here.value - there.value) < 3.0 * std::hypot(here.error, there.error) + 0.01 * there.value);
  }
}

// The scalar oracle as a program: a scene's granules where the solver's pouring left them, then every step by the
// oracle.
//   reference_program SCENE.toml OUTPUT.csv [KEY=VALUE]...
// Writes time (s), displacement (m) and velocity (m/s) at every history_interval; the last line of standard output
// tells the steps and the processor time of one.
#include "io/scene_file.hpp"
#include "tests/support/reference_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <malloc.h>
#include <memory>
#include <string>
#include <vector>

using namespace grandamp;

namespace {

/// The scene with its granules placed and the step that the solver would take.
Scene placed(Scene scene) {
  Simulation simulation(scene, {1, "", {}});
  const GranuleTable start = simulation.granules();
  const Plan& plan = simulation.plan();
  scene.time.step = plan.time_step;
  scene.time.impact_speed = plan.impact_speed;
  for (Population& population : scene.populations) {
    population.positions.clear();
    population.velocities.clear();
    population.spins.clear();
  }
  for (std::size_t i = 0; i < start.position.size(); ++i) {
    Population& population = scene.populations[static_cast<std::size_t>(start.population[i])];
    population.placed = true;
    population.positions.push_back(start.position[i]);
    population.velocities.push_back(start.velocity[i]);
    population.spins.push_back(start.spin[i]);
  }
  return scene;
}

void run(const Scene& given, const char* output) {
  const Scene scene = placed(given);
  const double step = *scene.time.step;
  const std::int64_t steps = std::llround(scene.time.duration / step);
  const std::int64_t interval = std::max<std::int64_t>(1, std::llround(scene.output.history_interval / step));
  test::ReferenceRun oracle(scene, step);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(output, "w"), &std::fclose);
  if (!file) throw std::runtime_error(std::string("cannot write ") + output);
  std::fputs("time,displacement,velocity\n", file.get());
  const std::clock_t begin = std::clock();
  for (std::int64_t n = 0; n <= steps; ++n) {
    if (n % interval == 0) {
      const Sample now = oracle.sample();
      std::fprintf(file.get(), "%.17g,%.17g,%.17g\n", now.time, now.displacement, now.velocity);
    }
    if (n < steps) oracle.step();
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("%lld steps, %.1f us each\n", static_cast<long long>(steps),
              1.0e6 * seconds / static_cast<double>(steps));
}

} // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fputs("usage: reference_program SCENE.toml OUTPUT.csv [KEY=VALUE]...\n", stderr);
    return 2;
  }
  // A step's vectors are of the same sizes as the last one's: the memory is kept, not given back.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  try {
    run(read_scene(arguments[1], std::vector<std::string>(arguments + 3, arguments + count)).scene, arguments[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

// Times the steps of a scene through the library, as the program takes them: no packing, no files, no output.
// Prints one JSON object.
#include "io/scene_file.hpp"
#include "perf/timing.hpp"
#include "solver/simulation.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <malloc.h>
#include <optional>

namespace {

using namespace grandamp;

struct Arguments {
  std::string scene, isa, intervals;
  std::vector<std::string> overrides;
  std::int64_t warm = 0, steps = 1000;
  int windows = 1, threads = 1;
  std::vector<int> tiles;
};

/// Copies of the scene's granules side by side along x and y, the box growing with them.
void tile(Scene& scene, int along_x, int along_y) {
  const Vector3 box = scene.enclosure.size;
  for (Population& population : scene.populations) {
    const Population one = population;
    population.count = 0;
    const auto clear = [](auto&... lists) { (lists.clear(), ...); };
    clear(population.positions, population.velocities, population.spins, population.radii, population.masses);
    for (int x = 0; x < along_x; ++x)
      for (int y = 0; y < along_y; ++y) {
        const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        for (const Vector3& p : one.positions)
          population.positions.push_back({p[0] + x * box[0], p[1] + y * box[1], p[2]});
        append(population.velocities, one.velocities);
        append(population.spins, one.spins);
        append(population.radii, one.radii);
        append(population.masses, one.masses);
        population.count += one.count;
      }
  }
  scene.enclosure.size = {along_x * box[0], along_y * box[1], box[2]};
}

/// Long enough for the steps to be timed, with the step that the scene would take anyway.
void set_duration(Scene& scene, std::int64_t steps) {
  if (!scene.time.step) scene.time.step = make_plan(scene).time_step;
  scene.time.duration = *scene.time.step * static_cast<double>(steps);
  scene.output.window.reset();
}

/// A row per list: when it was built, and how many steps it lasted.
class IntervalLog {
public:
  explicit IntervalLog(const std::string& file) : out_(file) { out_ << "time,interval\n"; }
  void note(const Simulation& simulation) {
    const std::int64_t builds = simulation.verlet().builds;
    if (builds != builds_ && builds_ != 0) {
      out_ << built_at_ * simulation.plan().time_step << ',' << simulation.step_number() - 1 - built_at_step_ << '\n';
    }
    if (builds != builds_) {
      built_at_step_ = simulation.step_number() - 1;
      built_at_ = static_cast<double>(built_at_step_);
      builds_ = builds;
    }
  }

private:
  std::ofstream out_;
  std::int64_t builds_ = 0, built_at_step_ = 0;
  double built_at_ = 0.0;
};

nlohmann::ordered_json timed(Scene& scene, const Arguments& arguments) {
  nlohmann::ordered_json out;
  std::vector<double> processor, wall;
  std::optional<Simulation> simulation;
  double contacts = 0.0;
  std::int64_t builds = 0;
  malloc_trim(0);
  const std::size_t before = perf::resident_bytes();
  for (int window = 0; window < arguments.windows; ++window) {
    RunOptions options;
    options.threads = arguments.threads;
    options.isa = arguments.isa;
    simulation.emplace(scene, options);
    for (std::int64_t k = 0; k < arguments.warm; ++k) simulation->step();
    contacts = 0.5 * static_cast<double>(simulation->sample().contacts);
    builds = simulation->verlet().builds;
    const auto per_step = [&](double seconds) { return 1e9 * seconds / static_cast<double>(arguments.steps); };
    if (arguments.intervals.empty()) {
      const perf::Stopwatch watch;
      perf::toggle_instruction_count();
      for (std::int64_t k = 0; k < arguments.steps; ++k) simulation->step();
      perf::toggle_instruction_count();
      processor.push_back(per_step(watch.processor()));
      wall.push_back(per_step(watch.wall()));
    } else {
      IntervalLog log(arguments.intervals);
      for (std::int64_t k = 0; k < arguments.steps; ++k) {
        simulation->step();
        log.note(*simulation);
      }
    }
    builds = simulation->verlet().builds - builds;
  }
  malloc_trim(0);
  const std::size_t after = perf::resident_bytes();
  contacts += 0.5 * static_cast<double>(simulation->sample().contacts);
  const Plan& plan = simulation->plan();
  const VerletStatistics verlet = simulation->verlet();
  const double granules = static_cast<double>(plan.granules);
  out["granules"] = plan.granules;
  out["time_step"] = plan.time_step;
  out["steps"] = arguments.steps;
  out["warm"] = arguments.warm;
  out["isa"] = simulation->isa();
  out["threads"] = simulation->threads();
  out["processor_ns_per_step"] = processor;
  out["wall_ns_per_step"] = wall;
  out["contacts_per_granule"] = contacts / granules;
  out["candidates_per_granule"] = verlet.candidates_per_granule;
  out["builds"] = builds;
  out["mean_interval"] = builds > 0 ? static_cast<double>(arguments.steps) / static_cast<double>(builds) : 0.0;
  out["skin_over_diameter"] = 0.5 * verlet.skin / plan.largest_radius;
  out["missed"] = verlet.missed;
  out["bytes_per_granule"] = after > before ? static_cast<double>(after - before) / granules : 0.0;
  out["peak_bytes_per_granule"] = static_cast<double>(perf::peak_resident_bytes()) / granules;
  out["effects"] = plan.effects;
  return out;
}

void parse(CLI::App& app, Arguments& arguments) {
  app.add_option("scene", arguments.scene, "Scene file")->required();
  app.add_option("--set", arguments.overrides, "KEY=VALUE")->allow_extra_args(false);
  app.add_option("--isa", arguments.isa, "generic, avx2 or avx512");
  app.add_option("--threads", arguments.threads, "Threads");
  app.add_option("--warm", arguments.warm, "Steps before the clock starts");
  app.add_option("--steps", arguments.steps, "Steps that are timed")->check(CLI::PositiveNumber);
  app.add_option("--windows", arguments.windows, "Times to do it, each from the start")->check(CLI::PositiveNumber);
  app.add_option("--tile", arguments.tiles, "Copies along x and y of a bed given by positions in a box")->expected(2);
  app.add_option("--intervals", arguments.intervals, "CSV of the lists' ages, instead of timing");
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app("Times the steps of a scene");
  Arguments arguments;
  parse(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    Scene scene = grandamp::read_scene(arguments.scene, arguments.overrides).scene;
    if (!arguments.tiles.empty()) tile(scene, arguments.tiles[0], arguments.tiles[1]);
    set_duration(scene, arguments.warm + arguments.steps);
    std::printf("%s\n", timed(scene, arguments).dump().c_str());
  } catch (const grandamp::SceneError& error) {
    std::fputs(grandamp::format_problems(arguments.scene, error.problems()).c_str(), stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}

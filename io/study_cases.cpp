#include "io/study_cases.hpp"

#include "io/json.hpp"
#include "io/recorder.hpp"
#include "io/study_start.hpp"
#include "io/summary.hpp"
#include "io/text_file.hpp"
#include "solver/errors.hpp"
#include "solver/team.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <exception>
#include <fstream>
#include <mutex>
#include <thread>

namespace grandamp {

namespace {

namespace fs = std::filesystem;

/// A step of fewer granules is not worth sharing (solver/simulation.cpp): such cases run side by side instead.
constexpr std::size_t worth_sharing = 20000;
constexpr std::int64_t audit_interval = 4; ///< steps; no contact is so short

double processor_seconds() {
  timespec now{};
  return clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0
             ? static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec)
             : 0.0;
}

struct Task {
  const StudySetting* setting;
  int seed;
  bool audit;
  fs::path file;
};

std::map<std::string, double> observables_of(const Simulation& simulation, const Sample& end) {
  std::map<std::string, double> values;
  if (simulation.plan().scene.structure) {
    const ResponseStatistics response = simulation.response();
    values["rms_displacement"] = response.rms_displacement;
    values["amplitude"] = response.amplitude;
  } else {
    values["kinetic"] = end.stored.kinetic;
  }
  const Ledger& ledger = end.ledger;
  values["normal_granule"] = ledger.normal_granule;
  values["normal_wall"] = ledger.normal_wall;
  values["friction_granule"] = ledger.friction_granule;
  values["friction_wall"] = ledger.friction_wall;
  values["dissipated"] = ledger.normal_granule + ledger.normal_wall + ledger.friction_granule + ledger.friction_wall;
  values["contacts_per_granule"] = simulation.verlet().contacts_per_granule;
  // A window shorter than a period has no amplitude.
  std::erase_if(values, [](const auto& value) { return !std::isfinite(value.second); });
  return values;
}

std::string text_of(const StudyCase& one) {
  Json json{{"setting", one.setting},
            {"seed", one.seed},
            {"audit", one.audit},
            {"stopped", one.stopped},
            {"steps", one.steps},
            {"wall_time", one.wall_time},
            {"processor_time", one.processor_time},
            {"rate", one.rate},
            {"residual", one.residual},
            {"max_overlap", one.max_overlap},
            {"audited", one.audited},
            {"missed", one.missed},
            {"audited_time", one.audited_time},
            {"observables", one.observables}};
  return json.dump(2) + "\n";
}

std::optional<StudyCase> read_case(const fs::path& file) {
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    StudyCase one;
    one.setting = json.at("setting");
    one.seed = json.at("seed");
    one.audit = json.at("audit");
    one.stopped = json.at("stopped");
    one.steps = json.at("steps");
    one.wall_time = json.at("wall_time");
    one.processor_time = json.at("processor_time");
    one.rate = json.at("rate");
    one.residual = json.at("residual");
    one.max_overlap = json.at("max_overlap");
    one.audited = json.at("audited");
    one.missed = json.at("missed");
    one.audited_time = json.at("audited_time");
    one.observables = json.at("observables").get<std::map<std::string, double>>();
    return one;
  } catch (const Json::exception&) {
    return std::nullopt; // a damaged file is a case to be run again
  }
}

class CaseRunner {
public:
  CaseRunner(const SceneDocument& document, const std::string& name, const StudyOptions& options, int threads)
      : document_(document), name_(name), options_(options), threads_(threads),
        starts_(document, name, options.isa, threads, [this] { throw_if_stopped(); }), begun_(WallClock::now()) {}

  bool stopped() const {
    return (options_.stop_requested && options_.stop_requested()) ||
           (options_.max_wall > 0.0 && seconds_since(begun_) >= options_.max_wall);
  }
  double seconds() const { return seconds_since(begun_); }

  /// Throws StudyInterrupted.
  StudyCase run(const Task& task) {
    StudyCase result;
    result.setting = task.setting->name;
    result.seed = task.seed;
    result.audit = task.audit;
    std::vector<std::string> overrides = task.setting->overrides;
    if (task.audit) add_audit(*task.setting, overrides);
    Scene scene = scene_under(document_, name_, overrides).scene;
    starts_.put(scene, task.seed);
    RunOptions run;
    run.threads = threads_;
    run.isa = options_.isa;
    Simulation simulation(scene, run);
    const Sample initial = simulation.sample();
    const WallClock::time_point start = WallClock::now();
    const double processor_start = processor_seconds();
    try {
      step_through(simulation);
    } catch (const GuardError& error) {
      result.stopped = error.what();
    }
    result.processor_time = threads_ == 1 ? processor_seconds() - processor_start : 0.0;
    result.wall_time = seconds_since(start);
    result.steps = simulation.step_number();
    result.max_overlap = simulation.guards().max_overlap;
    result.audited = simulation.verlet().audited;
    result.missed = simulation.verlet().missed;
    result.audited_time = task.audit ? simulation.time() : 0.0;
    const double granule_steps = static_cast<double>(simulation.plan().granules) * static_cast<double>(result.steps);
    if (result.time() > 0.0) result.rate = granule_steps / result.time();
    if (!result.stopped.empty()) return result;
    const Sample end = simulation.sample();
    result.residual = energy_residual(initial, end);
    result.observables = observables_of(simulation, end);
    return result;
  }

private:
  void throw_if_stopped() const {
    if (stopped()) throw StudyInterrupted{};
  }

  /// Every few steps against all pairs: as much of the run as that leaves time for.
  void add_audit(const StudySetting& setting, std::vector<std::string>& overrides) const {
    const auto granules = static_cast<double>(starts_.granules());
    const double seconds = 0.5e-9 * granules * granules + 3e-7 * granules;
    const double steps = static_cast<double>(audit_interval) * std::max(8.0, study_audit_seconds / seconds);
    const double duration = std::min(document_.scene.time.duration, steps * setting.time_step);
    overrides.push_back(fmt::format("verlet.audit={}", audit_interval));
    overrides.push_back(fmt::format("time.duration={}", duration));
  }

  void step_through(Simulation& simulation) const {
    const Plan& plan = simulation.plan();
    OutputSchedule schedule(plan.scene.output.history_interval, plan.time_step, 0);
    const auto granules = static_cast<std::int64_t>(plan.granules);
    const std::int64_t between_looks = std::clamp<std::int64_t>(200'000 / std::max<std::int64_t>(granules, 1), 1, 1000);
    while (!simulation.finished()) {
      if (simulation.step_number() % between_looks == 0) throw_if_stopped();
      if (schedule.due(simulation.step_number())) {
        simulation.step_and_sample();
        schedule.advance();
      } else {
        simulation.step();
      }
    }
  }

  const SceneDocument& document_;
  std::string name_;
  const StudyOptions& options_;
  int threads_;
  StudyStarts starts_;
  WallClock::time_point begun_;
};

std::vector<Task> tasks_of(const StudySettings& settings, const fs::path& folder, int seeds) {
  std::vector<Task> tasks;
  const std::vector<StudySetting>& all = settings.settings;
  const auto file = [&](const StudySetting& setting, int seed, const char* what) {
    return folder / "cases" / fmt::format("{}_{}{}.json", setting.name, what, seed);
  };
  for (int seed = 0; seed < seeds; ++seed) {
    const std::size_t first = static_cast<std::size_t>(seed) * all.size() / static_cast<std::size_t>(seeds);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const StudySetting& setting = all[(first + k) % all.size()];
      tasks.push_back({&setting, seed, false, file(setting, seed, "seed")});
    }
  }
  for (const StudySetting& setting : all)
    if (setting.audited) tasks.push_back({&setting, 0, true, file(setting, 0, "audit")});
  return tasks;
}

/// Hands out tasks to threads and collects what they bring.
class Pool {
public:
  Pool(CaseRunner& runner, const StudyOptions& options, std::vector<Task> tasks, StudyCases& cases)
      : runner_(runner), options_(options), tasks_(std::move(tasks)), cases_(cases) {
    for (const Task& task : tasks_) seconds_all_ += seconds_of(task);
  }

  void run(int threads) {
    tell();
    std::vector<std::thread> team;
    for (int k = 1; k < threads; ++k) team.emplace_back([this] { work(); });
    work();
    for (std::thread& one : team) one.join();
    if (failure_) std::rethrow_exception(failure_);
  }

private:
  static double seconds_of(const Task& task) { return task.audit ? study_audit_seconds : task.setting->seconds; }

  void work() {
    for (;;) {
      const std::size_t k = next_.fetch_add(1);
      if (k >= tasks_.size() || given_up_) return;
      try {
        StudyCase done = runner_.run(tasks_[k]);
        const std::lock_guard lock(mutex_);
        replace_file(tasks_[k].file, text_of(done));
        cases_.done.push_back(std::move(done));
        seconds_done_ += seconds_of(tasks_[k]);
        ++done_here_;
        tell();
      } catch (const StudyInterrupted&) {
        given_up_ = true;
        const std::lock_guard lock(mutex_);
        cases_.interrupted = true;
      } catch (...) {
        given_up_ = true;
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
      }
    }
  }

  void tell() {
    if (!options_.progress) return;
    const double seconds = runner_.seconds();
    const double left = seconds_done_ > 0.0 ? seconds * (seconds_all_ - seconds_done_) / seconds_done_ : -1.0;
    const std::size_t begun = std::min(next_.load(), tasks_.size());
    options_.progress({cases_.done.size(), begun - done_here_, cases_.planned, seconds, left});
  }

  CaseRunner& runner_;
  const StudyOptions& options_;
  std::vector<Task> tasks_;
  StudyCases& cases_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> given_up_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::size_t done_here_ = 0;
  double seconds_all_ = 0.0, seconds_done_ = 0.0;
};

} // namespace

StudyThreads study_threads(std::size_t granules, int asked) {
  const int all = asked > 0 ? asked : usable_processors();
  return granules < worth_sharing ? StudyThreads{all, 1} : StudyThreads{1, all};
}

StudyCases run_cases(const SceneDocument& document, const std::string& name, const StudySettings& settings,
                     const fs::path& folder, const StudyOptions& options) {
  StudyCases cases;
  std::vector<Task> tasks = tasks_of(settings, folder, options.seeds);
  cases.planned = tasks.size();
  std::erase_if(tasks, [&](const Task& task) {
    std::optional<StudyCase> known = read_case(task.file);
    if (known) cases.done.push_back(std::move(*known));
    return known.has_value();
  });
  std::size_t granules = 0;
  for (const Population& population : document.scene.populations) granules += population.count;
  const StudyThreads threads = study_threads(granules, options.threads);
  CaseRunner runner(document, name, options, threads.each);
  Pool(runner, options, std::move(tasks), cases).run(threads.cases);
  return cases;
}

} // namespace grandamp

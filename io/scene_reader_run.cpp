#include "io/scene_reader.hpp"

#include <cmath>
#include <fmt/format.h>

namespace grandamp {

namespace {

constexpr double most_steps = 1e15; // beyond, a step's number times the step is not exact
constexpr double most_rows = 1e9;   // of a history: more is a mistake in the interval
constexpr double most_snapshots = 1e6;

void read_step(TableReader& table, TimeControl& time) {
  const std::string_view key = table.one_of({"step", "steps_per_contact", "error"});
  if (key == "error") {
    time.error = table.number(key, {0.0, 0.5, false, true});
    time.integrator_free = !table.has("integrator");
  } else if (key == "steps_per_contact") {
    time.steps_per_contact = table.number(key, {1.0, 1e6, true, true}).value_or(time.steps_per_contact);
  } else if (key == "step") {
    time.step = table.number_or_word(key, positive, "adaptive", time.adaptive);
    if (!time.step) return;
    if (time.duration > 0.0 && *time.step > time.duration)
      table.wrong(key, "longer than the run", fmt::format("above 0 and at most the duration, {} s", time.duration));
    else if (time.duration / *time.step > most_steps)
      table.wrong(key, fmt::format("that is {:.3g} steps", time.duration / *time.step),
                  fmt::format("at least {:.3g} s", time.duration / most_steps));
  }
}

void check_rows(TableReader& table, double interval, double duration) {
  if (duration > 0.0 && duration / interval > most_rows)
    table.wrong("history_interval", fmt::format("that is {:.3g} rows", duration / interval),
                fmt::format("at least {:.3g} s", duration / most_rows));
}

void check_snapshots(TableReader& table, double interval, double duration) {
  if (interval > 0.0 && duration > 0.0 && duration / interval > most_snapshots)
    table.wrong("snapshot_interval", fmt::format("that is {:.3g} snapshots", duration / interval),
                fmt::format("0 (none), or at least {:.3g} s", duration / most_snapshots));
}

void read_window(TableReader& table, Scene& scene) {
  table.pass("window");
  const std::optional<std::array<double, 2>> window = table.pair("window");
  if (!window) return;
  const double duration = scene.time.duration;
  const std::string allowed = fmt::format("[from, to] in s, 0 <= from < to <= the duration{}",
                                          duration > 0.0 ? fmt::format(", {}", duration) : "");
  if (!((*window)[0] >= 0.0 && (*window)[0] < (*window)[1])) return table.wrong("window", "out of range", allowed);
  if (duration > 0.0 && (*window)[1] > duration) {
    // An override of the duration alone leaves the file's window without meaning: its default then holds.
    if (table.reading().is_overridden("time.duration"))
      table.idle("window", fmt::format("it ends after the run, at {} s; the last half is used", duration), allowed);
    else
      table.wrong("window", "ends after the run", allowed);
    return;
  }
  scene.output.window = *window;
}

} // namespace

void read_time(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("time"), "time");
  if (!root.has("time")) return root.missing("time", "how long the run is", "a table [time] with a duration");
  if (!table.exists()) return;
  if (!table.has("duration")) table.missing("duration", "how long the run is", "s, above 0");
  scene.time.duration = table.number("duration", positive).value_or(0.0);
  read_step(table, scene.time);
  scene.time.impact_speed = table.number("impact_speed", positive);
  scene.time.integrator =
      table.choice<Integrator>("integrator", {{"leapfrog", Integrator::leapfrog}, {"verlet", Integrator::verlet}})
          .value_or(Integrator::leapfrog);
  scene.time.precision =
      table.choice<Precision>("precision", {{"double", Precision::full}, {"mixed", Precision::mixed}})
          .value_or(Precision::full);
  table.finish();
}

void read_verlet(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("verlet"), "verlet");
  VerletControl& verlet = scene.verlet;
  const auto policy = table.choice<ListPolicy>("policy", {{"guarded", ListPolicy::guarded},
                                                          {"predicted", ListPolicy::predicted},
                                                          {"displacement", ListPolicy::displacement},
                                                          {"fixed", ListPolicy::fixed},
                                                          {"none", ListPolicy::none},
                                                          {"all-pairs", ListPolicy::all_pairs}});
  const bool known = policy || !table.has("policy");
  verlet.policy = policy.value_or(ListPolicy::guarded);
  const bool lists = verlet.policy != ListPolicy::none && verlet.policy != ListPolicy::all_pairs;
  if (known && !lists)
    table.idle("skin", "this policy keeps no list from step to step", "no skin; or a policy with a list");
  else
    verlet.skin = table.number("skin", {0.0, 100.0, false, true});
  if (known && verlet.policy == ListPolicy::all_pairs)
    table.idle("cell", "policy \"all-pairs\" has no grid", "no cell; or another policy");
  else
    verlet.cell = table.number("cell", {1.0, 1000.0, true, true});
  const auto belongs = [&](std::string_view key, ListPolicy owner, std::string_view name) {
    if (known && verlet.policy != owner)
      table.idle(key, fmt::format("only policy \"{}\" has it", name), fmt::format("policy = \"{}\"", name));
  };
  belongs("safety", ListPolicy::predicted, "predicted");
  belongs("max_interval", ListPolicy::predicted, "predicted");
  belongs("interval", ListPolicy::fixed, "fixed");
  constexpr int most = 1000000000;
  verlet.safety = table.number("safety", positive).value_or(verlet.safety);
  verlet.max_interval = static_cast<int>(table.integer("max_interval", 1, most).value_or(verlet.max_interval));
  verlet.interval = static_cast<int>(table.integer("interval", 1, most).value_or(verlet.interval));
  verlet.audit = table.integer("audit", 0, std::numeric_limits<std::int64_t>::max()).value_or(0);
  table.finish();
}

void read_output(TableReader& root, Scene& scene) {
  TableReader table(root.reading(), root.table("output"), "output");
  OutputControl& output = scene.output;
  output.history_interval = table.number("history_interval", positive).value_or(output.history_interval);
  check_rows(table, output.history_interval, scene.time.duration);
  output.snapshot_interval = table.number("snapshot_interval", not_negative).value_or(output.snapshot_interval);
  check_snapshots(table, output.snapshot_interval, scene.time.duration);
  output.checkpoint_interval = table.number("checkpoint_interval", not_negative).value_or(output.checkpoint_interval);
  read_window(table, scene);
  output.energy = table.flag("energy").value_or(true);
  table.finish();
}

} // namespace grandamp

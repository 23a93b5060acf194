#include "solver/simulation.hpp"

#include "solver/energy_watch.hpp"
#include "solver/errors.hpp"
#include "solver/packing.hpp"
#include "solver/pouring.hpp"
#include "solver/response.hpp"
#include "solver/run_state.hpp"
#include "solver/several_modes.hpp"
#include "solver/stepper.hpp"
#include "solver/vibration_cycles.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace grandamp {

namespace {

kernels::InstructionSet chosen_isa(const std::string& name) {
  if (name.empty()) return kernels::best_available();
  std::string offered;
  for (const auto set :
       {kernels::InstructionSet::generic, kernels::InstructionSet::avx2, kernels::InstructionSet::avx512}) {
    if (!kernels::available(set)) continue;
    if (name == kernels::name(set)) return set;
    offered += (offered.empty() ? "" : ", ") + std::string(kernels::name(set));
  }
  throw SceneError(Problem{
      .key = "--isa", .value = name, .message = "this binary on this machine has no such kernels", .allowed = offered});
}

/// A step of fewer granules is too short to be worth sharing.
constexpr std::size_t worth_sharing = 20000;

int chosen_threads(int asked, std::size_t granules) {
  if (asked < 0)
    throw SceneError(Problem{.key = "--threads",
                             .value = std::to_string(asked),
                             .message = "not a number of threads",
                             .allowed = "1 or more; 0: chosen"});
  if (asked > 0) return asked;
  return granules < worth_sharing ? 1 : usable_processors();
}

double forcing_period(const Excitation& excitation) {
  const bool periodic = excitation.kind == ExcitationKind::harmonic || excitation.kind == ExcitationKind::base ||
                        (excitation.kind == ExcitationKind::prescribed && !excitation.velocity);
  return periodic && excitation.frequency > 0.0 ? 1.0 / excitation.frequency : 0.0;
}

Placement placed(const Plan& plan, kernels::InstructionSet isa, int threads, const RunOptions& options) {
  Placement placement = place_granules(plan, [&options] {
    if (options.pouring_progress) options.pouring_progress({});
  });
  if (placement.to_be_poured)
    pour(plan, placement, isa, threads, options.pouring_progress, options.poured_so_far);
  else if (options.poured_so_far != nullptr)
    throw StateError("the state is of granules being poured, and this scene pours none");
  return placement;
}

std::optional<VibrationCycles> cycles_of(const Plan& plan) {
  if (!plan.scene.structure || plan.scene.excitation.kind != ExcitationKind::none) return std::nullopt;
  if (has_several_modes(plan.scene)) return std::nullopt; // no one mass swings
  return VibrationCycles(plan.scene.structure->mass, plan.time_step);
}

ResponseAccumulator::State response_of(const RunState& s) {
  return {s.response_samples,   s.response_sum_of_squares,    s.response_peak,
          s.response_last_step, s.response_last_displacement, s.response_last_velocity,
          s.response_cycle,     s.response_highest,           s.response_lowest,
          s.response_rising,    s.response_last_turn,         s.response_turn_before,
          s.response_amplitudes};
}

void save_response(const ResponseAccumulator::State& from, RunState& s) {
  s.response_samples = from.samples;
  s.response_sum_of_squares = from.sum_of_squares;
  s.response_peak = from.peak;
  s.response_last_step = from.last_step;
  s.response_last_displacement = from.last_displacement;
  s.response_last_velocity = from.last_velocity;
  s.response_cycle = from.cycle;
  s.response_highest = from.highest;
  s.response_lowest = from.lowest;
  s.response_rising = from.rising;
  s.response_last_turn = from.last_turn;
  s.response_turn_before = from.turn_before;
  s.response_amplitudes = from.amplitudes;
}

/// The plan of a run that goes on: its end and its window may have been moved.
Plan plan_of(const Scene& scene, const RunState& saved) {
  Plan plan = make_plan(scene);
  if (saved.steps != plan.steps) plan.scene.time.duration = static_cast<double>(saved.steps) * plan.time_step;
  plan.steps = saved.steps;
  plan.window = saved.window;
  return plan;
}

/// The kernels asked for, or those with the bits of the state's.
kernels::InstructionSet isa_for(const RunState& saved, const std::string& name) {
  if (!name.empty()) return chosen_isa(name);
  return saved.fused ? kernels::best_available() : kernels::InstructionSet::generic;
}

} // namespace

struct Simulation::State {
  State(const Scene& scene, const RunOptions& options)
      : plan(make_plan(scene)), isa(chosen_isa(options.isa)), isa_name(kernels::name(isa)),
        stepper(plan, placed(plan, isa, chosen_threads(options.threads, plan.granules), options), isa,
                chosen_threads(options.threads, plan.granules)),
        response(plan.window, forcing_period(plan.scene.excitation), plan.time_step), cycles(cycles_of(plan)) {}

  State(const Scene& scene, const RunState& saved, const RunOptions& options)
      : plan(plan_of(scene, saved)), isa(isa_for(saved, options.isa)), isa_name(kernels::name(isa)),
        stepper(plan, saved, isa, chosen_threads(options.threads, plan.granules)),
        response(plan.window, forcing_period(plan.scene.excitation), plan.time_step), cycles(cycles_of(plan)),
        end_noted(saved.end_noted), contact_samples(saved.contact_samples), contacts_sum(saved.contacts_sum) {
    response.restore(response_of(saved));
    balance.restore({saved.balance_samples, saved.balance_first, saved.balance_gravitational, saved.balance_largest,
                     saved.balance_beyond, saved.warned_balance});
    if (cycles && !cycles->restore(saved.vibration_cycles)) throw StateError("the state of the cycles is none");
  }

  Sample sample_of(const StepRecord& record, std::int64_t step_number) const {
    Sample sample;
    sample.time = static_cast<double>(step_number) * plan.time_step;
    sample.displacement = record.enclosure.displacement;
    sample.velocity = record.enclosure.velocity;
    sample.excitation = record.enclosure.excitation;
    sample.reaction = record.reaction;
    sample.wall_force = record.wall_force;
    sample.stored.kinetic = record.kinetic;
    sample.stored.elastic = record.elastic;
    sample.stored.structure = record.enclosure.stored;
    for (std::size_t k = 0; k < 3; ++k)
      sample.stored.gravitational -=
          plan.scene.gravity[k] * (record.mass_moment[k] + granules_moved_by(record.enclosure, k));
    sample.contacts = record.contacts;
    if (plan.scene.output.energy) sample.ledger = record.until;
    return sample;
  }

  /// Moment of the granules' mass by the enclosure's displacement, kg m.
  double granules_moved_by(const EnclosureStep& enclosure, std::size_t k) const {
    if (has_several_modes(plan.scene)) return plan.damper.granule_mass * enclosure.place[k];
    return plan.damper.granule_mass * enclosure.displacement * stepper.motion().direction()[k];
  }

  void note(std::int64_t step_number, const StepRecord& record) {
    if (std::exchange(end_noted, false)) return; // the run was to end here, and goes on
    if (plan.scene.structure) response.add(step_number, record.enclosure.displacement, record.enclosure.velocity);
    if (cycles) cycles->add(step_number, record.enclosure.displacement, record.enclosure.velocity);
  }

  /// No step starts from the last instant, which belongs to the statistics like all others.
  void note_end() {
    const std::int64_t now = stepper.step_number();
    if (now < plan.steps || end_noted) return;
    note(now, stepper.trial(false));
    end_noted = true;
  }

  Plan plan;
  kernels::InstructionSet isa;
  std::string isa_name;
  Stepper stepper;
  ResponseAccumulator response;
  std::optional<VibrationCycles> cycles; ///< free vibration
  EnergyWatch balance;
  std::vector<std::string> warnings; ///< of the balance
  bool end_noted = false;
  std::int64_t contact_samples = 0;
  double contacts_sum = 0.0;
};

Simulation::Simulation(const Scene& scene, const RunOptions& options)
    : state_(std::make_unique<State>(scene, options)) {}
Simulation::Simulation(const Scene& scene, const RunState& state, const RunOptions& options)
    : state_(std::make_unique<State>(scene, state, options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const Plan& Simulation::plan() const {
  return state_->plan;
}
const std::string& Simulation::isa() const {
  return state_->isa_name;
}
int Simulation::threads() const {
  return state_->stepper.threads();
}
std::int64_t Simulation::step_number() const {
  return state_->stepper.step_number();
}
double Simulation::time() const {
  return state_->stepper.time();
}
bool Simulation::finished() const {
  return step_number() >= state_->plan.steps;
}

void Simulation::step() {
  const std::int64_t at = step_number();
  state_->note(at, state_->stepper.step(false));
  state_->note_end();
}

Sample Simulation::step_and_sample() {
  State& s = *state_;
  const std::int64_t at = step_number();
  const StepRecord& record = s.stepper.step(true);
  s.note(at, record);
  Sample sample = s.sample_of(record, at);
  if (auto warning = s.balance.note(sample, s.plan, s.stepper.guards())) s.warnings.push_back(std::move(*warning));
  if (s.plan.granules > 0) {
    ++s.contact_samples;
    s.contacts_sum += static_cast<double>(sample.contacts) / static_cast<double>(s.plan.granules);
  }
  s.note_end();
  return sample;
}

Sample Simulation::sample() {
  return state_->sample_of(state_->stepper.trial(true), step_number());
}

GranuleTable Simulation::granules() {
  RowArray<kernels::MotionRow> mean;
  const StepRecord record = state_->stepper.trial(false, &mean);
  const Granules& rows = state_->stepper.granules();
  const Vector3& frame = record.enclosure.mean_velocity;
  GranuleTable table;
  const std::uint32_t count = rows.count();
  table.position.resize(count);
  table.velocity.resize(count);
  table.spin.resize(count);
  table.radius.resize(count);
  table.population.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    const std::uint32_t id = rows.id[row];
    const kernels::PositionRow& p = rows.position[row];
    table.position[id] = {p.x, p.y, p.z};
    for (std::size_t k = 0; k < 3; ++k) {
      table.velocity[id][k] = mean[row].velocity[k] + frame[k];
      table.spin[id][k] = mean[row].surface_spin[k] / p.radius;
    }
    table.radius[id] = p.radius;
    table.population[id] = rows.population[row];
  }
  table.contacts = state_->stepper.contacts();
  return table;
}

VerletStatistics Simulation::verlet() const {
  VerletStatistics v = state_->stepper.verlet();
  if (state_->contact_samples > 0)
    v.contacts_per_granule = state_->contacts_sum / static_cast<double>(state_->contact_samples);
  return v;
}

StepReviewStatistics Simulation::step_review() const {
  const StepReview::State& review = state_->stepper.review().state();
  return {review.refined, StepReview::parts[static_cast<std::size_t>(review.finest)]};
}
GuardStatistics Simulation::guards() const {
  return state_->stepper.guards();
}
ResponseStatistics Simulation::response() const {
  ResponseStatistics response = state_->response.result();
  if (state_->cycles) response.cycles = state_->cycles->result();
  return response;
}
RunState Simulation::state() const {
  RunState saved;
  state_->stepper.save(saved);
  saved.steps = state_->plan.steps;
  saved.window = state_->plan.window;
  save_response(state_->response.state(), saved);
  if (state_->cycles) saved.vibration_cycles = state_->cycles->state();
  const EnergyWatch::State& balance = state_->balance.state();
  saved.balance_samples = balance.samples;
  saved.balance_first = balance.first;
  saved.balance_gravitational = balance.gravitational;
  saved.balance_largest = balance.largest;
  saved.balance_beyond = balance.beyond;
  saved.warned_balance = balance.warned;
  saved.end_noted = state_->end_noted;
  saved.contact_samples = state_->contact_samples;
  saved.contacts_sum = state_->contacts_sum;
  return saved;
}

void Simulation::end_at(std::int64_t steps, std::optional<std::array<double, 2>> window) {
  Plan& plan = state_->plan;
  const double now = time(), duration = static_cast<double>(steps) * plan.time_step;
  if (steps < step_number()) throw std::invalid_argument("a run cannot end before now");
  if (!window) {
    window = {0.5 * duration, duration};
    if ((*window)[0] < now) (*window)[0] = std::min(plan.window[0], now);
  }
  if ((*window)[0] != plan.window[0] && (*window)[0] < now)
    throw std::invalid_argument("statistics cannot start before now");
  ResponseAccumulator response(*window, forcing_period(plan.scene.excitation), plan.time_step);
  if ((*window)[0] == plan.window[0])
    response.restore(state_->response.state());
  else
    state_->end_noted = false;
  state_->response = std::move(response);
  plan.steps = steps;
  plan.scene.time.duration = duration;
  plan.window = *window;
}

void Simulation::set_profile(Profile* profile) {
  state_->stepper.set_profile(profile);
}
std::vector<std::string> Simulation::take_warnings() {
  std::vector<std::string> warnings = state_->stepper.take_warnings();
  for (std::string& warning : std::exchange(state_->warnings, {})) warnings.push_back(std::move(warning));
  return warnings;
}

} // namespace grandamp

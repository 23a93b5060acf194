// The exact state of a run between two steps, as plain values and arrays: what a checkpoint holds. A Simulation made of
// it moves on by the same bits as the one it was taken from.
#pragma once

#include "solver/plan.hpp"
#include "solver/simulation.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace grandamp {

/// A state that belongs to another scene or another program, or that is none at all.
class StateError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A Verlet list without its padding. Ranges of pairs are those of each segment's blocks in order, then of its
/// boundary.
struct ListState {
  std::vector<std::uint32_t> segment_rows;   ///< first and one past the last row, by segment
  std::vector<std::uint32_t> segment_blocks; ///< number of blocks, by segment
  std::vector<std::uint32_t> block_rows;     ///< first, one past the last
  std::vector<std::uint32_t> class_pairs;    ///< number of pairs, by range and class of gaps
  std::vector<std::uint32_t> pairs;          ///< two rows each
  std::vector<std::uint32_t> wall_counts;    ///< by segment and wall
  std::vector<std::uint32_t> wall_rows;
};

/// Plain values; arrays by row, in the rows' order. `visit_fields` tells their names and units.
struct RunState {
  std::int64_t step_number = 0;
  std::int64_t steps = 0;
  double time_step = 0.0;
  std::array<double, 2> window{0.0, 0.0};
  bool fused = false;
  bool same_sizes = false;
  std::vector<double> constants;

  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> population;
  std::vector<double> position;
  std::vector<double> radius;
  std::vector<double> inverse_mass;
  std::vector<double> velocity;
  std::vector<double> surface_spin;
  std::vector<double> predicted_velocity;
  std::vector<double> predicted_surface_spin;
  std::vector<float> velocity_rate;
  std::vector<float> surface_spin_rate;
  std::vector<float> damping_granule, friction_granule;
  std::vector<std::uint32_t> at_wall; ///< rows of granules, rising; one entry of the next three for each
  std::vector<double> damping_wall, friction_wall, friction_wall_turn;
  std::vector<double> friction_share;

  ListState list;
  std::vector<std::uint32_t> spring_contacts;
  std::vector<double> springs;
  std::vector<double> built_at;
  double skin = 0.0;
  std::int64_t list_age = 0;
  double list_travelled = 0.0;
  double list_farthest = 0.0;
  std::int64_t list_allowed = 0;
  bool list_built = false;
  double tuner_skin = 0.0;
  double tuner_factor = 0.0;
  double tuner_last_cost = 0.0;
  std::int64_t tuner_rebuilds = 0;
  std::int64_t tuner_steps = 0;
  double tuner_candidates = 0.0;
  std::int64_t builds = 0;
  std::int64_t build_steps = 0;
  double candidates_sum = 0.0;

  double enclosure_displacement = 0.0;
  std::vector<double> enclosure_modes;
  double enclosure_velocity = 0.0;
  Ledger ledger;
  GuardStatistics guards;
  bool warned_overlap = false;
  bool warned_closing = false;
  std::int64_t review_level = 0;
  double review_speed = 0.0;
  std::int64_t review_refined = 0;
  std::int64_t review_finest = 0;
  std::int64_t balance_samples = 0;
  double balance_first = 0.0;
  double balance_gravitational = 0.0;
  double balance_largest = 0.0;
  std::int64_t balance_beyond = 0;
  bool warned_balance = false;

  std::int64_t audited = 0;
  std::int64_t missed = 0;
  std::int64_t missed_pair_steps = 0;
  std::vector<std::uint32_t> unlisted;

  std::int64_t response_samples = 0;
  double response_sum_of_squares = 0.0;
  double response_peak = 0.0;
  std::int64_t response_last_step = -1;
  double response_last_displacement = 0.0;
  double response_last_velocity = 0.0;
  std::int64_t response_cycle = -1;
  double response_highest = 0.0;
  double response_lowest = 0.0;
  bool response_rising = false;
  double response_last_turn = 0.0;
  double response_turn_before = 0.0;
  std::vector<double> response_amplitudes;
  std::vector<double> vibration_cycles;

  bool end_noted = false;
  std::int64_t contact_samples = 0;
  double contacts_sum = 0.0;
};

/// What a field is called and means. `width`: values in a row of it.
struct FieldInfo {
  const char* name;
  const char* units;
  const char* description;
  std::size_t width = 1;
};

/// Calls field(FieldInfo, value) for everything that there is: double, std::int64_t, bool, and vectors of double,
/// float, std::uint32_t and std::uint8_t. `State` is RunState or const RunState.
template <class State, class Field> void visit_fields(State& s, Field&& field) {
  field(FieldInfo{"step_number", "1", "steps done"}, s.step_number);
  field(FieldInfo{"steps", "1", "steps of the whole run"}, s.steps);
  field(FieldInfo{"time_step", "s", "of all steps"}, s.time_step);
  field(FieldInfo{"window_start", "s", "of the statistics"}, s.window[0]);
  field(FieldInfo{"window_end", "s", "of the statistics"}, s.window[1]);
  field(FieldInfo{"fused", "1", "multiplications and additions are fused: avx2, avx512"}, s.fused);
  field(FieldInfo{"same_sizes", "1", "all granules have one radius and one mass"}, s.same_sizes);
  field(FieldInfo{"constants", "1", "that the scene gave, and probes of the mathematics: another program's differ"},
        s.constants);

  field(FieldInfo{"granules/id", "1", "number in the scene's order"}, s.id);
  field(FieldInfo{"granules/population", "1", "of the scene, from 0"}, s.population);
  field(FieldInfo{"granules/position", "m", "centre, enclosure's frame, t_n", 3}, s.position);
  field(FieldInfo{"granules/radius", "m", "of the granule"}, s.radius);
  field(FieldInfo{"granules/inverse_mass", "1/kg", "one over the mass"}, s.inverse_mass);
  field(FieldInfo{"granules/velocity", "m/s", "enclosure's frame, half a step before t_n", 3}, s.velocity);
  field(FieldInfo{"granules/surface_spin", "m/s", "angular velocity times radius, half a step before t_n", 3},
        s.surface_spin);
  field(FieldInfo{"granules/predicted_velocity", "m/s", "verlet: at t_n, as forces see it", 3}, s.predicted_velocity);
  field(FieldInfo{"granules/predicted_surface_spin", "m/s", "verlet: at t_n, as forces see it", 3},
        s.predicted_surface_spin);
  field(FieldInfo{"granules/velocity_rate", "m/s^2", "ledger: from t_(n-3/2) to t_(n-1/2)", 3}, s.velocity_rate);
  field(FieldInfo{"granules/surface_spin_rate", "m/s^2", "ledger: likewise", 3}, s.surface_spin_rate);
  field(FieldInfo{"granules/damping_granule", "N", "ledger: sum of such forces at t_(n-1)", 3}, s.damping_granule);
  field(FieldInfo{"granules/friction_granule", "N", "ledger: likewise", 3}, s.friction_granule);
  field(FieldInfo{"at_wall/row", "1", "ledger: place in granules/... of who touched a wall at t_(n-1)"}, s.at_wall);
  field(FieldInfo{"at_wall/damping", "N", "ledger: sum of such forces at t_(n-1)", 3}, s.damping_wall);
  field(FieldInfo{"at_wall/friction", "N", "ledger: likewise", 3}, s.friction_wall);
  field(FieldInfo{"at_wall/friction_turn", "N", "ledger: their torque over the radius", 3}, s.friction_wall_turn);
  field(FieldInfo{"granules/friction_share", "1", "coulomb: of a slip, that one contact may take in a step"},
        s.friction_share);

  field(FieldInfo{"list/segment_rows", "1", "first row and one past the last", 2}, s.list.segment_rows);
  field(FieldInfo{"list/segment_blocks", "1", "blocks of each segment"}, s.list.segment_blocks);
  field(FieldInfo{"list/block_rows", "1", "first row, one past the last", 2}, s.list.block_rows);
  field(FieldInfo{"list/class_pairs", "1", "pairs by class of gaps: of each block, in its segment, then into the next"},
        s.list.class_pairs);
  field(FieldInfo{"list/pairs", "1", "two rows each", 2}, s.list.pairs);
  field(FieldInfo{"list/wall_counts", "1", "rows near each wall, by segment"}, s.list.wall_counts);
  field(FieldInfo{"list/wall_rows", "1", "rows near the walls"}, s.list.wall_rows);
  field(FieldInfo{"springs/contacts", "1", "loaded tangential springs: a granule's id, and its partner's; walls follow",
                  2},
        s.spring_contacts);
  field(FieldInfo{"springs/force", "N, m", "on the granule, at t_(n-1), and sqrt(R overlap) then", 4}, s.springs);
  field(FieldInfo{"list/built_at", "m", "policy displacement: positions at the last build", 3}, s.built_at);
  field(FieldInfo{"list/skin", "m", "in force"}, s.skin);
  field(FieldInfo{"list/age", "1", "steps since the last build"}, s.list_age);
  field(FieldInfo{"list/travelled", "m", "sum of the largest speed times the step"}, s.list_travelled);
  field(FieldInfo{"list/farthest", "m", "largest displacement since the last build"}, s.list_farthest);
  field(FieldInfo{"list/allowed", "1", "policy predicted: steps until the next build"}, s.list_allowed);
  field(FieldInfo{"list/built", "1", "there is a list"}, s.list_built);
  field(FieldInfo{"tuner/skin", "m", "on trial"}, s.tuner_skin);
  field(FieldInfo{"tuner/factor", "1", "of the next change"}, s.tuner_factor);
  field(FieldInfo{"tuner/last_cost", "1", "of the last trial, per granule and step"}, s.tuner_last_cost);
  field(FieldInfo{"tuner/rebuilds", "1", "of the present trial"}, s.tuner_rebuilds);
  field(FieldInfo{"tuner/steps", "1", "of the present trial"}, s.tuner_steps);
  field(FieldInfo{"tuner/candidates", "1", "of the present trial, per granule, summed over steps"}, s.tuner_candidates);
  field(FieldInfo{"list/builds", "1", "so far"}, s.builds);
  field(FieldInfo{"list/build_steps", "1", "steps that the lists so far lasted"}, s.build_steps);
  field(FieldInfo{"list/candidates_sum", "1", "per granule, summed over builds"}, s.candidates_sum);

  field(FieldInfo{"enclosure/displacement", "m", "half a step before t_n"}, s.enclosure_displacement);
  field(FieldInfo{"enclosure/velocity", "m/s", "half a step before t_n"}, s.enclosure_velocity);
  field(FieldInfo{"enclosure/modes", "SI", "several modes: coordinates, then their rates, half a step before t_n"},
        s.enclosure_modes);

  field(FieldInfo{"ledger/work_in", "J", "since t = 0, until half a step before t_n"}, s.ledger.work_in);
  field(FieldInfo{"ledger/structural_damping", "J", "likewise"}, s.ledger.structural_damping);
  field(FieldInfo{"ledger/normal_granule", "J", "likewise"}, s.ledger.normal_granule);
  field(FieldInfo{"ledger/normal_wall", "J", "likewise"}, s.ledger.normal_wall);
  field(FieldInfo{"ledger/friction_granule", "J", "likewise"}, s.ledger.friction_granule);
  field(FieldInfo{"ledger/friction_wall", "J", "likewise"}, s.ledger.friction_wall);

  field(FieldInfo{"guards/max_overlap", "1", "over the smaller radius, so far"}, s.guards.max_overlap);
  field(FieldInfo{"guards/max_speed", "m/s", "relative to the enclosure, so far"}, s.guards.max_speed);
  field(FieldInfo{"guards/max_closing", "m/s", "at a contact, so far"}, s.guards.max_closing);
  field(FieldInfo{"guards/escaped", "1", "granules beyond a wall"}, s.guards.escaped);
  field(FieldInfo{"guards/warned_overlap", "1", "the warning of deep overlaps was given"}, s.warned_overlap);
  field(FieldInfo{"guards/warned_closing", "1", "the warning of closing speeds was given"}, s.warned_closing);

  field(FieldInfo{"review/level", "1", "adaptive step: taken in 3^level parts"}, s.review_level);
  field(FieldInfo{"review/speed", "m/s", "adaptive step: largest since the last review"}, s.review_speed);
  field(FieldInfo{"review/refined", "1", "adaptive step: steps taken in parts, so far"}, s.review_refined);
  field(FieldInfo{"review/finest", "1", "adaptive step: largest level so far"}, s.review_finest);
  field(FieldInfo{"guards/balance_samples", "1", "of the energy balance, so far"}, s.balance_samples);
  field(FieldInfo{"guards/balance_first", "J", "stored energy less work, with losses, of the first one"},
        s.balance_first);
  field(FieldInfo{"guards/balance_gravitational", "J", "of the first one"}, s.balance_gravitational);
  field(FieldInfo{"guards/balance_largest", "J", "largest term of the balance, so far"}, s.balance_largest);
  field(FieldInfo{"guards/balance_beyond", "1", "samples in a row that the step does not explain"}, s.balance_beyond);
  field(FieldInfo{"guards/warned_balance", "1", "the warning of the energy balance was given"}, s.warned_balance);

  field(FieldInfo{"audit/audited", "1", "steps at which the list was compared"}, s.audited);
  field(FieldInfo{"audit/missed", "1", "contacts that began unlisted"}, s.missed);
  field(FieldInfo{"audit/missed_pair_steps", "1", "how long, summed"}, s.missed_pair_steps);
  field(FieldInfo{"audit/unlisted", "1", "contacts unlisted at the last comparison: ids, or id and wall", 2},
        s.unlisted);

  field(FieldInfo{"response/samples", "1", "steps inside the window so far"}, s.response_samples);
  field(FieldInfo{"response/sum_of_squares", "m^2", "of the displacement"}, s.response_sum_of_squares);
  field(FieldInfo{"response/peak", "m", "largest displacement"}, s.response_peak);
  field(FieldInfo{"response/last_step", "1", "inside the window; -1: none"}, s.response_last_step);
  field(FieldInfo{"response/last_displacement", "m", "at that step"}, s.response_last_displacement);
  field(FieldInfo{"response/last_velocity", "m/s", "at that step"}, s.response_last_velocity);
  field(FieldInfo{"response/cycle", "1", "forced: the present period; free: turning points so far"}, s.response_cycle);
  field(FieldInfo{"response/highest", "m", "in the present cycle"}, s.response_highest);
  field(FieldInfo{"response/lowest", "m", "in the present cycle"}, s.response_lowest);
  field(FieldInfo{"response/rising", "1", "free vibration: since the last turning point"}, s.response_rising);
  field(FieldInfo{"response/last_turn", "m", "free vibration: the last turning point"}, s.response_last_turn);
  field(FieldInfo{"response/turn_before", "m", "free vibration: the one before"}, s.response_turn_before);
  field(FieldInfo{"response/amplitudes", "m", "of whole cycles"}, s.response_amplitudes);
  field(FieldInfo{"response/vibration_cycles", "SI", "free vibration: the swings so far and the present one"},
        s.vibration_cycles);

  field(FieldInfo{"statistics/end_noted", "1", "the last instant of the run is in the statistics"}, s.end_noted);
  field(FieldInfo{"statistics/contact_samples", "1", "history samples so far"}, s.contact_samples);
  field(FieldInfo{"statistics/contacts_sum", "1", "contacts per granule, summed over history samples"}, s.contacts_sum);
}

/// Holds a state against the plan that it is said to belong to: lengths, ranges, indices, finite numbers. What passes
/// may be stepped without harm. Throws StateError.
void check_state(const RunState& state, const Plan& plan);

} // namespace grandamp

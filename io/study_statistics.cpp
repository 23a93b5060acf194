#include "io/study_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace grandamp {

namespace {

constexpr const char* observables[] = {"rms_displacement", "amplitude",      "kinetic",
                                       "dissipated",       "normal_granule", "normal_wall",
                                       "friction_granule", "friction_wall",  "contacts_per_granule"};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// Runs to the end, by setting.
using Runs = std::map<std::string, std::vector<const StudyCase*>>;

std::vector<double> values_of(const std::vector<const StudyCase*>& runs, const std::string& observable) {
  std::vector<double> values;
  for (const StudyCase* run : runs) {
    const auto found = run->observables.find(observable);
    if (found != run->observables.end()) values.push_back(found->second);
  }
  return values;
}

/// Standard deviation between seeds, of all settings of the scene's own model together.
double pooled_deviation(const StudySettings& settings, const Runs& runs, const std::string& observable) {
  double squares = 0.0, freedom = 0.0;
  for (const StudySetting& setting : settings.settings) {
    const auto found = runs.find(setting.name);
    if (setting.other_truth || found == runs.end()) continue;
    const std::vector<double> values = values_of(found->second, observable);
    const double middle = mean(values);
    for (const double value : values) squares += (value - middle) * (value - middle);
    freedom += std::max(0.0, static_cast<double>(values.size()) - 1.0);
  }
  return freedom > 0.0 ? std::sqrt(squares / freedom) : std::numeric_limits<double>::quiet_NaN();
}

void take_times(StudyRow& row, const std::vector<const StudyCase*>& runs, const std::vector<const StudyCase*>& own) {
  std::vector<double> times, walls, shares, own_times;
  for (const StudyCase* run : runs) {
    times.push_back(run->time());
    walls.push_back(run->wall_time);
    for (const StudyCase* other : own)
      if (other->seed == run->seed && other->time() > 0.0) {
        shares.push_back(run->time() / other->time());
        own_times.push_back(other->time());
      }
  }
  row.wall_time = median(walls);
  row.time = shares.empty() ? median(times) : median(shares) * median(own_times);
  if (!shares.empty() && median(shares) > 0.0)
    row.time_spread =
        0.5 * (*std::max_element(shares.begin(), shares.end()) - *std::min_element(shares.begin(), shares.end())) /
        median(shares);
  if (row.time > 0.0 && median(times) > 0.0) row.rate = runs.front()->rate * runs.front()->time() / row.time;
}

void take_runs(StudyRow& row, const std::vector<const StudyCase*>& runs) {
  row.runs = static_cast<int>(runs.size());
  std::vector<double> residuals;
  for (const StudyCase* run : runs) {
    residuals.push_back(run->residual);
    row.max_overlap = std::max(row.max_overlap, run->max_overlap);
  }
  row.residual = mean(residuals);
}

void compare(StudyRow& row, const std::vector<const StudyCase*>& runs, const std::vector<const StudyCase*>& reference,
             const std::map<std::string, double>& deviations) {
  for (const char* observable : observables) {
    const std::vector<double> values = values_of(runs, observable), right = values_of(reference, observable);
    if (values.empty() || right.empty() || mean(right) == 0.0) continue;
    StudyDifference& difference = row.differences.emplace_back();
    difference.observable = observable;
    difference.mean = mean(values);
    difference.relative = mean(values) / mean(right) - 1.0;
    const double both = &runs == &reference
                            ? 1.0 / static_cast<double>(values.size())
                            : 1.0 / static_cast<double>(values.size()) + 1.0 / static_cast<double>(right.size());
    difference.standard_error = deviations.at(observable) / std::abs(mean(right)) * std::sqrt(both);
  }
}

bool within(const StudyRow& row, double error) {
  return std::all_of(row.differences.begin(), row.differences.end(), [&](const StudyDifference& difference) {
    return !is_main(difference.observable) || std::abs(difference.relative) <= error || !difference.resolved();
  });
}

/// Times that differ by less are the same, and the smaller error of a contact decides.
constexpr double as_fast = 1.1;

bool eligible(const StudyRow& row) {
  return row.runs > 0 && row.stopped.empty() && !row.setting->other_truth && row.missed == 0;
}

} // namespace

std::string in_words(std::string observable) {
  std::replace(observable.begin(), observable.end(), '_', ' ');
  return observable;
}

bool is_main(const std::string& observable) {
  return observable == "rms_displacement" || observable == "amplitude" || observable == "kinetic" ||
         observable == "dissipated";
}

const StudyDifference* StudyRow::find(const std::string& observable) const {
  for (const StudyDifference& difference : differences)
    if (difference.observable == observable) return &difference;
  return nullptr;
}

double StudyRow::error() const {
  double largest = 0.0;
  for (const StudyDifference& difference : differences)
    if (is_main(difference.observable)) largest = std::max(largest, std::abs(difference.relative));
  return largest;
}

double StudyRow::scatter() const {
  double largest = 0.0;
  for (const StudyDifference& difference : differences) {
    if (!is_main(difference.observable)) continue;
    if (std::isnan(difference.standard_error)) return difference.standard_error;
    largest = std::max(largest, resolved_at * difference.standard_error);
  }
  return largest;
}

StudyTable study_table(const StudySettings& settings, const StudyCases& cases) {
  Runs runs;
  for (const StudyCase& one : cases.done)
    if (!one.audit && one.stopped.empty()) runs[one.setting].push_back(&one);
  std::map<std::string, double> deviations;
  for (const char* observable : observables) deviations[observable] = pooled_deviation(settings, runs, observable);
  const StudySetting* own = nullptr;
  const StudySetting* reference = nullptr;
  for (const StudySetting& setting : settings.settings) {
    if (setting.own) own = &setting;
    if (setting.reference) reference = &setting;
  }

  StudyTable table;
  for (const StudySetting& setting : settings.settings) {
    StudyRow& row = table.rows.emplace_back();
    row.setting = &setting;
    for (const StudyCase& one : cases.done) {
      if (one.setting != setting.name) continue;
      if (!one.stopped.empty()) row.stopped = one.stopped;
      if (!one.audit) continue;
      row.audited = true;
      row.missed = one.missed;
      row.audited_steps = one.audited;
      row.audited_time = one.audited_time;
    }
    const auto found = runs.find(setting.name);
    if (found == runs.end()) continue;
    take_runs(row, found->second);
    take_times(row, found->second, own != nullptr ? runs[own->name] : found->second);
    if (reference != nullptr) compare(row, found->second, runs[reference->name], deviations);
    table.seeds = std::max(table.seeds, row.runs);
  }
  for (const StudyRow& row : table.rows) {
    if (row.setting == own && row.runs > 0) table.own = &row;
    if (row.setting == reference && row.runs > 0) table.reference = &row;
  }
  return table;
}

std::vector<const StudyRow*> frontier(const StudyTable& table) {
  std::vector<const StudyRow*> fastest;
  for (const StudyRow& row : table.rows)
    if (eligible(row)) fastest.push_back(&row);
  std::stable_sort(fastest.begin(), fastest.end(), [](const auto* a, const auto* b) { return a->time < b->time; });
  std::vector<const StudyRow*> best;
  for (const StudyRow* row : fastest)
    if (best.empty() || row->setting->contact.error < best.back()->setting->contact.error) best.push_back(row);
  return best;
}

StudyAdvice advise(const StudyTable& table, double error) {
  StudyAdvice advice;
  std::vector<const StudyRow*> good;
  for (const StudyRow& row : table.rows) {
    if (!eligible(row)) continue;
    if (!row.differences.empty() && within(row, error)) good.push_back(&row);
    if (row.setting->contact.error <= error && (advice.by_contact == nullptr || row.time < advice.by_contact->time))
      advice.by_contact = &row;
  }
  double fastest = std::numeric_limits<double>::infinity();
  for (const StudyRow* row : good) fastest = std::min(fastest, row->time);
  for (const StudyRow* row : good)
    if (row->time <= as_fast * fastest && (advice.by_observables == nullptr ||
                                           row->setting->contact.error < advice.by_observables->setting->contact.error))
      advice.by_observables = row;
  if (advice.by_observables != nullptr && advice.by_observables->scatter() > error) {
    const double ratio = advice.by_observables->scatter() / error;
    advice.seeds_needed = static_cast<int>(std::ceil(std::min(1e6, ratio * ratio * table.seeds)));
  }
  return advice;
}

} // namespace grandamp

#include "io/design_search.hpp"

#include "io/run.hpp"

#include <fmt/format.h>
#include <nlopt.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grandamp {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_contenders = 4;
/// There is nothing more to be gained, or to be spent.
struct Enough {};

} // namespace

DesignSearch::DesignSearch(const SceneDocument& document, std::string name, std::filesystem::path folder,
                           const OptimiseOptions& options, std::function<bool(const std::vector<CaseJob>&)> run)
    : document_(document), name_(std::move(name)), folder_(std::move(folder)), options_(options), run_(std::move(run)),
      keys_(parse_over(options.over, options.overrides)) {
  std::vector<std::string> names;
  for (const FreeKey& key : keys_) names.push_back(key.key);
  if (options.keep_total_mass) kept_.emplace(document, names);
  // As many as a simplex needs, and the scene itself, so that it is known what a better design gains.
  const auto most = static_cast<std::size_t>(options_.evaluations);
  std::vector<double> own;
  for (const FreeKey& key : keys_) {
    const std::optional<double> value = number_in(document_.text, key.key);
    if (value && *value >= key.low && *value <= key.high) own.push_back(key.share_of(*value));
  }
  if (own.size() == keys_.size()) add(own, "scene", start_jobs_);
  const std::size_t start = std::min(2 * keys_.size() + 2, most);
  for (std::size_t k = 1; evaluations_.size() < start && k < 20 * start; ++k)
    add(halton_point(k, keys_.size()), "start", start_jobs_);
  start_ = evaluations_.size();
  if (!start_jobs_.empty()) return;
  if (!evaluations_.front().design.problems.empty()) throw SceneError(evaluations_.front().design.problems);
  throw UsageError("no design of the start can be run; the first: " + evaluations_.front().design.fault);
}

void DesignSearch::search() {
  const bool whole = run_(start_jobs_);
  for (Evaluation& one : evaluations_) look_at(one);
  if (!whole) throw SearchInterrupted();
  if (best_index() == evaluations_.size())
    throw GuardError("no design of the start has a result; the first: " + evaluations_.front().error);
  search_from_best();
  tell_apart_the_best();
}

std::string DesignSearch::key_of(const std::vector<double>& point) const {
  std::string text;
  for (const VaryValue& value : values_at(keys_, point)) text += value.text + ' ';
  return text;
}

void DesignSearch::add(const std::vector<double>& point, const std::string& part, std::vector<CaseJob>& jobs) {
  if (!known_.emplace(key_of(point), evaluations_.size()).second) return;
  Evaluation one;
  one.part = part;
  one.point = point;
  std::vector<VaryValue> values = values_at(keys_, point);
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < keys_.size(); ++i) overrides.push_back(keys_[i].key + '=' + values[i].text);
  try {
    if (kept_)
      for (std::string& other : kept_->overrides(values)) overrides.push_back(std::move(other));
    one.design = planned_point(document_, name_, std::move(values), std::move(overrides));
  } catch (const UsageError& error) { // a mass that no granules have
    one.design.values = values_at(keys_, point);
    one.design.fault = error.what();
  }
  for (int seed = 0; seed < options_.seeds; ++seed) {
    one.runs.push_back(run_of(one.design, evaluations_.size(), seed, document_.scene.seed, folder_));
    if (one.design.fault.empty()) jobs.push_back(one.runs.back().job);
  }
  evaluations_.push_back(std::move(one));
}

void DesignSearch::look_at(Evaluation& one) {
  one.values.clear();
  one.error = one.design.fault;
  for (CaseRun& run : one.runs) {
    run.state = one.design.fault.empty() ? state_of(run.job) : CaseState{CaseStatus::failed, 2, one.design.fault};
    run.numbers = run.state.status == CaseStatus::done ? CaseNumbers(summary_of(run.job)) : CaseNumbers();
    one.values.push_back(run.numbers.at(options_.number));
    if (!std::isnan(one.values.back()) || !one.error.empty()) continue;
    one.error = run.state.status == CaseStatus::done ? options_.number + " has no value" : run.state.error;
    if (one.error.empty()) one.error = "is not done";
  }
  const auto common = one.values.begin() + options_.seeds;
  one.result = one.good() ? mean_of({one.values.begin(), common}) : MeanAndError{0, nothing, nothing};
  one.all = one.good() ? mean_of(one.values) : one.result;
  const auto index = static_cast<std::size_t>(&one - evaluations_.data());
  const double before = index > 0 ? evaluations_[index - 1].best_so_far : nothing;
  const bool improves = one.good() && (std::isnan(before) || better(one.result.mean, before));
  one.best_so_far = improves ? one.result.mean : before;
}

std::size_t DesignSearch::best_index() const {
  std::size_t best = evaluations_.size();
  for (std::size_t k = 0; k < evaluations_.size(); ++k)
    if (evaluations_[k].good() && !evaluations_[k].values.empty() &&
        (best == evaluations_.size() || better(evaluations_[k].result.mean, evaluations_[best].result.mean)))
      best = k;
  return best;
}

const Evaluation* DesignSearch::best() const {
  const Evaluation* best = nullptr;
  for (const Evaluation& one : evaluations_) {
    if (!one.good() || one.values.empty()) continue;
    if (best == nullptr || one.all.count > best->all.count ||
        (one.all.count == best->all.count && better(one.all.mean, best->all.mean)))
      best = &one;
  }
  return best;
}

const Evaluation* DesignSearch::scene() const {
  const bool there = !evaluations_.empty() && evaluations_.front().part == "scene" && evaluations_.front().good() &&
                     !evaluations_.front().values.empty();
  return there ? &evaluations_.front() : nullptr;
}

MeanAndError DesignSearch::difference(const Evaluation& a, const Evaluation& b) {
  std::vector<double> differences;
  for (std::size_t k = 0; k < std::min(a.values.size(), b.values.size()); ++k)
    differences.push_back(b.values[k] - a.values[k]);
  return mean_of(differences);
}

void DesignSearch::search_from_best() {
  const auto most = static_cast<std::size_t>(options_.evaluations);
  const std::size_t from = best_index();
  const std::size_t dimensions = keys_.size();
  if (evaluations_.size() >= most) {
    reason_ = fmt::format("{} evaluations are made", most);
    return;
  }
  nlopt::opt method(nlopt::LN_SBPLX, static_cast<unsigned>(dimensions));
  method.set_lower_bounds(0.0);
  method.set_upper_bounds(1.0);
  // Half the way to the neighbours of a start that fills the space.
  method.set_initial_step(0.5 / std::pow(static_cast<double>(start_), 1.0 / static_cast<double>(dimensions)));
  method.set_xtol_abs(1e-3);
  method.set_maxeval(static_cast<int>(20 * most)); // designs met again cost nothing, but must not go on for ever
  method.set_min_objective(
      [](const std::vector<double>& point, std::vector<double>&, void* self) {
        DesignSearch& search = *static_cast<DesignSearch*>(self);
        try {
          return search.objective(point);
        } catch (...) { // NLopt would make all of them one
          search.thrown_ = std::current_exception();
          throw nlopt::forced_stop();
        }
      },
      this);
  std::vector<double> point = evaluations_[from].point;
  double value = 0.0;
  try {
    method.optimize(point, value);
  } catch (const nlopt::forced_stop&) {      // thrown_ tells why
  } catch (const nlopt::roundoff_limited&) { // as far as numbers go
  }
  try {
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    reason_ = "the search has come to rest";
  } catch (const Enough&) { // reason_ is told
  }
}

double DesignSearch::objective(const std::vector<double>& point) {
  const double sign = options_.maximise ? -1.0 : 1.0;
  if (!known_.contains(key_of(point))) {
    if (evaluations_.size() >= static_cast<std::size_t>(options_.evaluations)) {
      reason_ = fmt::format("{} evaluations are made", options_.evaluations);
      throw Enough();
    }
    std::vector<CaseJob> jobs;
    add(point, "search", jobs);
    const bool whole = run_(jobs);
    look_at(evaluations_.back());
    if (!whole) throw SearchInterrupted();
    if (gains_nothing()) {
      reason_ = "what the last evaluations gained is less than its standard error";
      throw Enough();
    }
  }
  const Evaluation& one = evaluations_[known_.at(key_of(point))];
  if (one.good()) return sign * one.result.mean;
  // A design that cannot be run is worse than any that can, and no cliff.
  double worst = -std::numeric_limits<double>::infinity(), least = -worst;
  for (const Evaluation& other : evaluations_)
    if (other.good()) {
      worst = std::max(worst, sign * other.result.mean);
      least = std::min(least, sign * other.result.mean);
    }
  return worst + 0.5 * (worst - least) + 1e-3 * std::abs(worst);
}

bool DesignSearch::gains_nothing() const {
  const std::size_t patience = 2 * keys_.size() + 3;
  if (evaluations_.size() < start_ + patience) return false;
  const std::size_t before = evaluations_.size() - patience;
  const std::size_t now = best_index();
  std::size_t then = evaluations_.size();
  for (std::size_t k = 0; k < before; ++k)
    if (evaluations_[k].good() &&
        (then == evaluations_.size() || better(evaluations_[k].result.mean, evaluations_[then].result.mean)))
      then = k;
  if (then == now) return true;
  const MeanAndError gain = difference(evaluations_[then], evaluations_[now]);
  return !std::isnan(gain.error) && std::abs(gain.mean) <= gain.error;
}

void DesignSearch::tell_apart_the_best() {
  const std::size_t best = best_index();
  std::vector<std::size_t> contenders;
  for (std::size_t k = 0; k < evaluations_.size(); ++k) {
    if (!evaluations_[k].good()) continue;
    const MeanAndError behind = difference(evaluations_[best], evaluations_[k]);
    // One seed tells nothing of chance: then the first few are compared.
    if (k == best || std::isnan(behind.error) || std::abs(behind.mean) <= 2.0 * behind.error) contenders.push_back(k);
  }
  std::sort(contenders.begin(), contenders.end(), [this](std::size_t a, std::size_t b) {
    return better(evaluations_[a].result.mean, evaluations_[b].result.mean);
  });
  if (contenders.size() > most_contenders) contenders.resize(most_contenders);
  if (scene() != nullptr && std::find(contenders.begin(), contenders.end(), std::size_t{0}) == contenders.end() &&
      best != 0)
    contenders.push_back(0); // what is gained over the scene is told as sharply
  const int seeds = options_.seeds + std::max(options_.seeds, 2);
  std::vector<CaseJob> jobs;
  for (const std::size_t k : contenders)
    for (int seed = options_.seeds; seed < seeds; ++seed) {
      Evaluation& one = evaluations_[k];
      one.runs.push_back(run_of(one.design, k, seed, document_.scene.seed, folder_));
      jobs.push_back(one.runs.back().job);
    }
  const bool whole = run_(jobs);
  const std::string ended = std::move(reason_);
  reason_.clear();
  for (const std::size_t k : contenders) {
    Evaluation& one = evaluations_[k];
    if (!whole) one.runs.resize(static_cast<std::size_t>(options_.seeds));
    look_at(one);
  }
  for (std::size_t k = 0; k < evaluations_.size(); ++k) look_at(evaluations_[k]);
  if (!whole) throw SearchInterrupted();
  reason_ = ended;
}

} // namespace grandamp

// Designs tried, one after the other or many at once, and the search among them. Internal to io.
#pragma once

#include "io/design_space.hpp"
#include "io/kept_mass.hpp"
#include "io/optimise.hpp"
#include "io/sweep_grid.hpp"

#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// One design and its runs.
struct Evaluation {
  std::string part; ///< "scene", "start" or "search"
  std::vector<double> point;
  CasePoint design;
  std::vector<CaseRun> runs;  ///< from the first seed on
  std::vector<double> values; ///< of the number, run by run; NaN: failed
  MeanAndError result;        ///< of the seeds that all designs have
  MeanAndError all;           ///< of all its seeds
  std::string error;          ///< why it has no result
  double best_so_far = 0.0;   ///< of `result`, this one included; NaN: none yet
  bool good() const { return error.empty(); }
};

/// Thrown when the search was asked to stop.
struct SearchInterrupted {};

class DesignSearch {
public:
  /// `run`: runs jobs; false if it was asked to stop. Throws UsageError, SceneError (no design of the start is a
  /// scene).
  DesignSearch(const SceneDocument& document, std::string name, std::filesystem::path folder,
               const OptimiseOptions& options, std::function<bool(const std::vector<CaseJob>&)> run);

  /// All of it. Throws SearchInterrupted, GuardError (no design of the start has a result), FileError.
  void search();

  const std::vector<FreeKey>& keys() const { return keys_; }
  const std::vector<Evaluation>& evaluations() const { return evaluations_; }
  /// Of all its seeds, among those that have most; nothing while no design is good.
  const Evaluation* best() const;
  /// The scene as it is, if its values lie between the bounds.
  const Evaluation* scene() const;
  /// Why it ended; empty: it has not.
  const std::string& reason() const { return reason_; }
  /// b less a, of the seeds that both have.
  static MeanAndError difference(const Evaluation& a, const Evaluation& b);

private:
  void add(const std::vector<double>& point, const std::string& part, std::vector<CaseJob>& jobs);
  void look_at(Evaluation& evaluation);
  std::string key_of(const std::vector<double>& point) const;
  void search_from_best();
  double objective(const std::vector<double>& point);
  bool gains_nothing() const;
  void tell_apart_the_best();
  std::size_t best_index() const; ///< by `result`; evaluations_.size(): none
  bool better(double a, double b) const { return options_.maximise ? a > b : a < b; }

  const SceneDocument& document_;
  std::string name_;
  std::filesystem::path folder_;
  const OptimiseOptions& options_;
  std::function<bool(const std::vector<CaseJob>&)> run_;
  std::vector<FreeKey> keys_;
  std::optional<KeptMass> kept_;
  std::vector<Evaluation> evaluations_;
  std::map<std::string, std::size_t> known_; ///< values -> evaluation
  std::size_t start_ = 0;                    ///< evaluations before NLopt's
  std::vector<CaseJob> start_jobs_;
  std::string reason_;
  std::exception_ptr thrown_; ///< by the objective, on its way past NLopt
};

} // namespace grandamp

// What is known of a run, and the parts of its page. Internal to io.
#pragma once

#include "io/json.hpp"
#include "io/report_files.hpp"
#include "io/report_page.hpp"
#include "io/results.hpp"
#include "solver/plan.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace grandamp::report {

struct RunFacts {
  // JSON says that to make a null and to move throws nothing, and calls what may.
  RunFacts() noexcept(false) = default;
  RunFacts(const RunFacts&) = default; // not moved
  RunFacts& operator=(const RunFacts&) = default;
  ~RunFacts() = default;

  std::filesystem::path folder;
  Json summary; ///< null: the run has none; it still goes on, or was killed
  std::string scene_text;
  std::optional<Scene> scene; ///< empty: this version does not read it
  std::optional<Plan> plan;
  std::string written; ///< when results were last written, UTC
  History history;

  const std::vector<double>* column(std::string_view name) const; ///< null: there is none
  double end() const;                                             ///< time of the last row, s
  std::array<double, 2> window() const;                           ///< of the statistics, s; NaN without a structure
  double forcing_frequency() const;                               ///< of one tone, Hz; NaN without
};

/// Throws FileError.
RunFacts read_run(const std::filesystem::path& folder);

/// Half the peak-to-peak of each whole period of the forcing, or of each cycle of free vibration.
struct Cycle {
  double start = 0.0;     ///< s
  double end = 0.0;       ///< s
  double amplitude = 0.0; ///< m
};
std::vector<Cycle> cycles_of(const RunFacts& run);

void add_key_numbers(Page& page, const RunFacts& run);
void add_description(Page& page, const RunFacts& run);
class HistoryBook;
void add_histories(Page& page, const RunFacts& run, HistoryBook& book);
void add_amplitudes(Page& page, const RunFacts& run);
/// The frequency response, where the run left one.
void add_spectrum(Page& page, const RunFacts& run);
void add_energy(Page& page, const RunFacts& run, HistoryBook& book);
void add_granules(Page& page, const RunFacts& run);
void add_search_and_time(Page& page, const RunFacts& run);
Page run_page(const std::filesystem::path& folder);

} // namespace grandamp::report

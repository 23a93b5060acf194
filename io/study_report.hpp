// A study on paper: study.csv, study.json, study.md and its pictures. Internal to io.
#pragma once

#include "io/study_statistics.hpp"

#include <filesystem>
#include <string>

namespace grandamp {

struct StudyReport {
  const StudyTable* table = nullptr;
  const StudySettings* settings = nullptr;
  std::string title;
  double error = 0.01;
  std::size_t done = 0, planned = 0; ///< runs
  StudyThreads threads;
  std::string isa;

  std::string paragraph() const; ///< what to choose for `error`, and what it rests on
  std::string csv() const;
  std::string json() const;
  std::string markdown() const;
};

/// error_time.svg (of a contact), response_time.svg (of the observables), rate_step.svg, missed_policy.svg.
void write_study_pictures(const StudyReport& report, const std::filesystem::path& folder);

} // namespace grandamp

// What a search for a design tells: in words, as CSV, as JSON, in pictures. Internal to io.
#pragma once

#include "io/design_search.hpp"

#include <filesystem>
#include <string>

namespace grandamp {

struct OptimiseReport {
  const DesignSearch* search = nullptr;
  const SceneDocument* document = nullptr;
  std::string title, isa;
  std::string number; ///< of the summary
  bool maximise = false, keep_total_mass = false;
  int seeds = 1;

  std::string paragraph() const; ///< empty: no design is good yet
  std::string csv() const;
  std::string json() const;
  /// optimise.svg and design_1.svg, design_2.svg, ... for each key. Throws FileError.
  void write_pictures(const std::filesystem::path& folder) const;
};

} // namespace grandamp

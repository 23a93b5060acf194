// The numbers of a summary, and what those of several seeds come to. Internal to io.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace grandamp {

/// Numbers under their dotted keys ("structure.amplitude"), in the order of the summary. Truth is 1 or 0; lists and
/// nulls are left out. `energy.dissipated` is added: what contacts took, all four mechanisms.
class CaseNumbers {
public:
  CaseNumbers() = default;
  /// None if the text is no summary.
  explicit CaseNumbers(const std::string& summary);

  const std::vector<std::string>& names() const { return names_; }
  bool has(const std::string& name) const { return values_.contains(name); }
  /// NaN if there is none of that name.
  double at(const std::string& name) const;
  void put(const std::string& name, double value);

private:
  std::vector<std::string> names_;
  std::map<std::string, double> values_;
};

struct MeanAndError {
  std::size_t count = 0;
  double mean = 0.0;  ///< NaN without values
  double error = 0.0; ///< standard error of the mean; NaN with fewer than two values
};
/// NaNs among the values are left out.
MeanAndError mean_of(const std::vector<double>& values);

/// Whether a number says something of the damper, and belongs into tables.
bool is_of_interest(const std::string& name);

} // namespace grandamp

#include "io/case_numbers.hpp"

#include "io/json.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace grandamp {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

void collect(const Json& node, const std::string& path, CaseNumbers& numbers) {
  if (node.is_object()) {
    for (const auto& [key, inner] : node.items()) {
      std::string inner_path = path;
      if (!path.empty()) inner_path += '.';
      inner_path += key;
      collect(inner, inner_path, numbers);
    }
  } else if (node.is_number()) {
    numbers.put(path, node.get<double>());
  } else if (node.is_boolean()) {
    numbers.put(path, node.get<bool>() ? 1.0 : 0.0);
  }
}

} // namespace

CaseNumbers::CaseNumbers(const std::string& summary) {
  const Json json = Json::parse(summary, nullptr, false);
  if (!json.is_object()) return;
  collect(json, "", *this);
  double dissipated = 0.0;
  for (const char* one : {"normal_granule", "normal_wall", "friction_granule", "friction_wall"})
    dissipated += at(std::string("energy.") + one);
  if (!std::isnan(dissipated)) put("energy.dissipated", dissipated);
}

double CaseNumbers::at(const std::string& name) const {
  const auto found = values_.find(name);
  return found != values_.end() ? found->second : nothing;
}

void CaseNumbers::put(const std::string& name, double value) {
  if (values_.emplace(name, value).second) names_.push_back(name);
}

MeanAndError mean_of(const std::vector<double>& values) {
  MeanAndError result{0, nothing, nothing};
  double sum = 0.0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    ++result.count;
  }
  if (result.count == 0) return result;
  const auto count = static_cast<double>(result.count);
  result.mean = sum / count;
  if (result.count < 2) return result;
  double squares = 0.0;
  for (const double value : values)
    if (!std::isnan(value)) squares += (value - result.mean) * (value - result.mean);
  result.error = std::sqrt(squares / (count - 1.0) / count);
  return result;
}

bool is_of_interest(const std::string& name) {
  if (name.starts_with("energy.initial.") || name == "energy.time") return false;
  constexpr std::array<std::string_view, 3> single{"wall_time", "guards.max_overlap", "verlet.contacts_per_granule"};
  for (const std::string_view one : single)
    if (name == one) return true;
  return name.starts_with("structure.") || name.starts_with("energy.") || name.starts_with("damping.") ||
         name.starts_with("response.");
}

} // namespace grandamp

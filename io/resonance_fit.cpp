#include "io/resonance_fit.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grandamp {
namespace {

constexpr std::size_t fewest_lines = 5;

struct Range {
  std::size_t begin, end;
};

Range around_the_top(const std::vector<std::complex<double>>& response) {
  const auto less = [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); };
  const auto top = std::max_element(response.begin(), response.end(), less);
  const double half = 0.5 * std::abs(*top);
  Range range{static_cast<std::size_t>(top - response.begin()), static_cast<std::size_t>(top - response.begin()) + 1};
  while (range.begin > 0 && std::abs(response[range.begin - 1]) >= half) --range.begin;
  while (range.end < response.size() && std::abs(response[range.end]) >= half) ++range.end;
  while (range.end - range.begin < std::min(fewest_lines, response.size())) {
    if (range.begin > 0) --range.begin;
    if (range.end < response.size()) ++range.end;
  }
  return range;
}

} // namespace

ResonanceFit fit_resonance(const std::vector<double>& frequency, const std::vector<std::complex<double>>& response) {
  ResonanceFit fit;
  if (response.size() < 3) return fit;
  const Range range = around_the_top(response);
  fit.lines = range.end - range.begin;
  // In units of the top's frequency the three columns are of one size.
  const double unit = 2.0 * std::numbers::pi * 0.5 * (frequency[range.begin] + frequency[range.end - 1]);
  double scale = 0.0;
  for (std::size_t k = range.begin; k < range.end; ++k) scale = std::max(scale, std::abs(response[k]));
  if (!(scale > 0.0)) return fit;
  const auto rows = static_cast<Eigen::Index>(2 * fit.lines);
  Eigen::MatrixXd matrix(rows, 3);
  Eigen::VectorXd ones(rows);
  for (std::size_t k = range.begin; k < range.end; ++k) {
    const auto row = static_cast<Eigen::Index>(2 * (k - range.begin));
    const double w = 2.0 * std::numbers::pi * frequency[k] / unit;
    const std::complex<double> h = response[k] / scale;
    matrix.row(row) << h.real(), -w * w * h.real(), -w * h.imag();
    matrix.row(row + 1) << h.imag(), -w * w * h.imag(), w * h.real();
    ones[row] = 1.0 / scale;
    ones[row + 1] = 0.0;
  }
  const Eigen::Vector3d solution = matrix.colPivHouseholderQr().solve(ones);
  fit.stiffness = solution[0];
  fit.mass = solution[1] / (unit * unit);
  fit.damping = solution[2] / unit;
  if (!(fit.stiffness > 0.0 && fit.mass > 0.0 && fit.damping > 0.0)) return fit;
  fit.found = true;
  fit.natural_frequency = std::sqrt(fit.stiffness / fit.mass) / (2.0 * std::numbers::pi);
  fit.damping_ratio = 0.5 * fit.damping / std::sqrt(fit.stiffness * fit.mass);
  const double squared = fit.damping_ratio * fit.damping_ratio;
  if (squared < 0.5) {
    fit.peak_frequency = fit.natural_frequency * std::sqrt(1.0 - 2.0 * squared);
    fit.peak_magnitude = 1.0 / (2.0 * fit.damping_ratio * std::sqrt(1.0 - squared) * fit.stiffness);
  }
  return fit;
}

} // namespace grandamp

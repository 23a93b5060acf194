#include "solver/periodic_random_force.hpp"

#include "solver/chebyshev.hpp"
#include "solver/random_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

using std::numbers::pi;
/// Tells the phases apart from what else a scene's seed is for.
constexpr std::uint64_t phase_stream = 0x51b7c0de00000000ULL;
/// A band that ends on a multiple of 1/period but for rounding includes it.
constexpr double rounding = 1.0e-9;

std::int64_t first_line(double low, double period) {
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(low * period * (1.0 - rounding))));
}

std::int64_t last_line(double high, double period) {
  return static_cast<std::int64_t>(std::floor(high * period * (1.0 + rounding)));
}

} // namespace

std::int64_t PeriodicRandomForce::lines_in(std::array<double, 2> band, double period) {
  return std::max<std::int64_t>(0, last_line(band[1], period) - first_line(band[0], period) + 1);
}

PeriodicRandomForce::PeriodicRandomForce(double rms, std::array<double, 2> band, double period,
                                         std::uint64_t scene_seed, std::uint64_t seed)
    : period_(period), first_(first_line(band[0], period)), phase_(static_cast<std::size_t>(lines_in(band, period))) {
  amplitude_ = phase_.empty() ? 0.0 : rms * std::sqrt(2.0 / static_cast<double>(phase_.size()));
  cells_ = std::max<std::int64_t>(1, 2 * last_line(band[1], period));
  RandomNumbers numbers(scene_seed + 0x9e3779b97f4a7c15ULL * seed, phase_stream);
  for (double& phase : phase_) phase = numbers.uniform();
}

const PeriodicRandomForce::Cell& PeriodicRandomForce::cell_at(std::int64_t number) const {
  Cell& cell = known_[static_cast<std::size_t>(number & 1)];
  if (cell.number == number) return cell;
  cell.number = number;
  std::array<double, nodes> node, values{};
  for (std::size_t i = 0; i < nodes; ++i)
    node[i] = 0.5 - 0.5 * std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(nodes));
  for (std::size_t j = 0; j < phase_.size(); ++j) {
    const std::int64_t line = first_ + static_cast<std::int64_t>(j);
    // Whole cycles dropped in integers: line * number stays exact up to 9e18.
    const double cycles = static_cast<double>(line * number % cells_) / static_cast<double>(cells_) + phase_[j];
    const double per_cell = static_cast<double>(line) / static_cast<double>(cells_);
    for (std::size_t i = 0; i < nodes; ++i) values[i] += std::sin(2.0 * pi * (cycles + per_cell * node[i]));
  }
  for (std::size_t k = 0; k < nodes; ++k) {
    cell.coefficient[k] = 0.0;
    for (std::size_t i = 0; i < nodes; ++i)
      cell.coefficient[k] +=
          (k % 2 == 0 ? 1.0 : -1.0) * values[i] *
          std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(nodes) * static_cast<double>(k));
    cell.coefficient[k] *= amplitude_ * (k == 0 ? 1.0 : 2.0) / static_cast<double>(nodes);
  }
  return cell;
}

double PeriodicRandomForce::at(Instant instant) const {
  const double periods = std::floor((instant.time + instant.rest) / period_);
  // Since the period began, with the product's rounding error; a rounding may put it just outside.
  const double within = std::fma(-periods, period_, instant.time) + instant.rest;
  const double place = within / period_ * static_cast<double>(cells_);
  const double number = std::clamp(std::floor(place), 0.0, static_cast<double>(cells_ - 1));
  const Cell& cell = cell_at(static_cast<std::int64_t>(number));
  const double x = 2.0 * (place - number) - 1.0;
  return chebyshev_sum(cell.coefficient, x);
}

} // namespace grandamp

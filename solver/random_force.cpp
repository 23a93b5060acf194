#include "solver/random_force.hpp"

#include "solver/chebyshev.hpp"
#include "solver/random_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

using std::numbers::pi;
/// Tells the phases apart from what else a scene's seed is for.
constexpr std::uint64_t phase_stream = 0x9d3c5a7e00000000ULL;

/// Rises from 0 to 1 in the middle and falls again, over a block from 0 to 1; smooth at its ends.
double window(double place) {
  const double sine = std::sin(pi * place);
  return std::sin(0.5 * pi * sine * sine);
}

} // namespace

RandomForce::RandomForce(double rms, std::array<double, 2> band, std::uint64_t scene_seed, std::uint64_t seed)
    : amplitude_(rms * std::sqrt(2.0 / lines)), scene_seed_(scene_seed), seed_(seed) {
  const double spacing = (band[1] - band[0]) / lines;
  for (std::size_t j = 0; j < lines; ++j) frequency_[j] = band[0] + (static_cast<double>(j) + 0.5) * spacing;
  const double half_block = 0.5 / spacing;
  const double cells = std::ceil(2.0 * band[1] * half_block);
  cells_ = static_cast<std::int64_t>(cells);
  cell_length_ = half_block / cells;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double angle = pi * (static_cast<double>(i) + 0.5) / nodes;
    node_[i] = 0.5 - 0.5 * std::cos(angle);
    for (std::size_t k = 0; k < nodes; ++k) // of -cos(angle), so with alternating signs
      transform_[k][i] =
          (k == 0 ? 1.0 : 2.0) / nodes * (k % 2 == 0 ? 1.0 : -1.0) * std::cos(angle * static_cast<double>(k));
    for (std::size_t j = 0; j < lines; ++j) {
      const double grows = 2.0 * pi * frequency_[j] * cell_length_ * node_[i];
      sine_[i][j] = std::sin(grows);
      cosine_[i][j] = std::cos(grows);
    }
  }
}

const RandomForce::Block& RandomForce::block_at(std::int64_t number) const {
  Block& block = known_blocks_[static_cast<std::size_t>(number & 1)];
  if (block.number == number) return block;
  block.number = number;
  RandomNumbers numbers(scene_seed_ + 0x9e3779b97f4a7c15ULL * seed_, phase_stream + static_cast<std::uint64_t>(number));
  for (double& phase : block.phase) phase = numbers.uniform();
  return block;
}

void RandomForce::add_block(std::int64_t block, std::int64_t cell_in_block, std::array<double, nodes>& values) const {
  const Block& known = block_at(block);
  const double start = static_cast<double>(cell_in_block) * cell_length_;
  std::array<double, lines> sine, cosine;
  for (std::size_t j = 0; j < lines; ++j) {
    const double cycles = frequency_[j] * start + known.phase[j];
    const double angle = 2.0 * pi * (cycles - std::floor(cycles));
    sine[j] = std::sin(angle);
    cosine[j] = std::cos(angle);
  }
  for (std::size_t i = 0; i < nodes; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < lines; ++j) sum += sine[j] * cosine_[i][j] + cosine[j] * sine_[i][j];
    const double place = 0.5 * (static_cast<double>(cell_in_block) + node_[i]) / static_cast<double>(cells_);
    values[i] += amplitude_ * window(place) * sum;
  }
}

const RandomForce::Cell& RandomForce::cell_at(std::int64_t number) const {
  Cell& cell = known_cells_[static_cast<std::size_t>(number & 1)];
  if (cell.number == number) return cell;
  cell.number = number;
  // Block b begins with the cell b * cells_ and lasts for two times cells_.
  const std::int64_t later = number >= 0 ? number / cells_ : -((-number + cells_ - 1) / cells_);
  std::array<double, nodes> values{};
  add_block(later, number - later * cells_, values);
  add_block(later - 1, number - (later - 1) * cells_, values);
  for (std::size_t k = 0; k < nodes; ++k) {
    cell.coefficient[k] = 0.0;
    for (std::size_t i = 0; i < nodes; ++i) cell.coefficient[k] += transform_[k][i] * values[i];
  }
  return cell;
}

double RandomForce::at(Instant instant) const {
  const double number = std::floor(instant.time / cell_length_);
  const Cell& cell = cell_at(static_cast<std::int64_t>(number));
  // From -1 to 1 over the cell; the product with its rounding error.
  const double within = std::fma(-number, cell_length_, instant.time) + instant.rest;
  const double x = 2.0 * within / cell_length_ - 1.0;
  return chebyshev_sum(cell.coefficient, x);
}

} // namespace grandamp

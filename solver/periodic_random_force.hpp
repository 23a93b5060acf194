// A band-limited random force that repeats itself: what whole periods of it drive is read without leakage.
#pragma once

#include "solver/excitation_signal.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grandamp {

/// Sines of equal amplitude on the multiples of 1/period in the band, with phases at random (a random-phase multisine:
/// R. Pintelon, J. Schoukens, System Identification, 2nd ed. 2012, ch. 5). A pure function of the seeds and of time.
/// The force is evaluated through its Chebyshev interpolant over half a period of the highest frequency, which is off
/// by less than 1e-9 of the rms, and remembers the last two of them: not for several threads at once.
class PeriodicRandomForce : public ForceSignal {
public:
  PeriodicRandomForce(double rms, std::array<double, 2> band, double period, std::uint64_t scene_seed,
                      std::uint64_t seed);
  double at(Instant instant) const override;

  /// Beyond, the sines of every half period of the highest frequency would take longer than what they drive.
  static constexpr std::int64_t most_lines = 100'000;
  /// How many sines a band holds.
  static std::int64_t lines_in(std::array<double, 2> band, double period);

private:
  static constexpr std::size_t nodes = 12;

  struct Cell {
    std::int64_t number = -1;                ///< in the period
    std::array<double, nodes> coefficient{}; ///< of Chebyshev polynomials
  };
  const Cell& cell_at(std::int64_t number) const;

  double period_;
  double amplitude_ = 0.0;    ///< of a line, N
  std::int64_t first_ = 0;    ///< line, in multiples of 1/period
  std::int64_t cells_ = 1;    ///< in a period
  std::vector<double> phase_; ///< by line, in cycles
  mutable std::array<Cell, 2> known_;
};

} // namespace grandamp

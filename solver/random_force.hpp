// A band-limited random force that is a pure function of the seeds and of time.
#pragma once

#include "solver/excitation_signal.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grandamp {

/// Blocks of length L overlap by half. A block is a sum of 128 sines of equal amplitude, 1/L apart in the middle of as
/// many parts of the band, with phases of its own at random, under a window whose square and that of its neighbours add
/// up to one: the mean square is the same at any time, the spectrum is flat inside the band and never repeats, and any
/// stretch is had without what came before. (Spectral representation: M. Shinozuka, G. Deodatis, Appl. Mech. Rev. 44
/// (1991) 191.) The force is evaluated through its Chebyshev interpolant over half a period of the highest frequency,
/// which is off by less than 1e-9 of the rms, and remembers the last two of them: not for several threads at once.
class RandomForce : public ForceSignal {
public:
  RandomForce(double rms, std::array<double, 2> band, std::uint64_t scene_seed, std::uint64_t seed);
  double at(Instant instant) const override;

private:
  static constexpr std::size_t lines = 128;
  static constexpr std::size_t nodes = 12;

  struct Cell {
    std::int64_t number = std::numeric_limits<std::int64_t>::min();
    std::array<double, nodes> coefficient{}; ///< of Chebyshev polynomials
  };
  struct Block {
    std::int64_t number = std::numeric_limits<std::int64_t>::min();
    std::array<double, lines> phase{}; ///< in cycles
  };
  const Cell& cell_at(std::int64_t number) const;
  const Block& block_at(std::int64_t number) const;
  void add_block(std::int64_t block, std::int64_t cell_in_block, std::array<double, nodes>& values) const;

  double amplitude_;         ///< of a line, N
  std::int64_t cells_ = 1;   ///< in half a block
  double cell_length_ = 1.0; ///< s
  std::uint64_t scene_seed_, seed_;
  std::array<double, lines> frequency_{}; ///< Hz
  /// Sine and cosine of what a line's phase grows by from the start of a cell to its nodes.
  std::array<std::array<double, lines>, nodes> sine_{}, cosine_{};
  std::array<double, nodes> node_{}; ///< within a cell, 0 to 1
  std::array<std::array<double, nodes>, nodes> transform_{};
  mutable std::array<Cell, 2> known_cells_;
  mutable std::array<Block, 2> known_blocks_;
};

} // namespace grandamp

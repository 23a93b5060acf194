// Force and displacement of a run at even distances in time, as transforms need them.
#pragma once

#include <cstddef>
#include <vector>

namespace grandamp {

/// Rows of the histories: all of one length, time rising.
struct ResponseHistory {
  std::vector<double> time;         ///< s
  std::vector<double> displacement; ///< m
  std::vector<double> velocity;     ///< m/s
  std::vector<double> force;        ///< N
};

struct EvenRecord {
  double interval = 0.0; ///< s
  std::vector<double> displacement;
  std::vector<double> force;
};

/// `count` values from the time `start` on, `interval` seconds apart, all within the rows. Rows are at the steps
/// nearest to multiples of an interval, and so not quite even: between them the displacement is the cubic through two
/// rows' displacements and velocities, the force the cubic through four rows. Both are exact at the rows, and within 1
/// % at eight rows per period.
EvenRecord even_record(const ResponseHistory& rows, double start, double interval, std::size_t count);

} // namespace grandamp
